#include "io/study/study_reference.h"

#include "tests/support/expect_error.h"
#include "tests/support/files.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// What light of 1 in each channel looks like through walks with a standard error of `noise`.
StudyReference noisy_reference(int points, double noise, test::Random& random) {
  StudyReference reference;
  std::vector<SurfacePoint> places;
  for (int k = 0; k < points; ++k) {
    places.push_back({Vec3(k, 0, 0), Vec3::UnitZ()});
    reference.direct.push_back(Rgb::Constant(0.6));
    Rgb off;
    for (double& v : off)  // normal, by Box and Muller
      v = noise * std::sqrt(-2 * std::log(1 - random(0, 1))) * std::cos(2 * M_PI * random(0, 1));
    reference.reflected.push_back(0.4 + off);
    reference.reflected_error.push_back(Rgb::Constant(noise));
  }
  reference.points = point_table(places);
  return reference;
}

TEST(StudyReference, NoiseIsTakenOffErrors) {
  test::Random random(1);
  constexpr double noise = 0.03;
  const StudyReference reference = noisy_reference(4000, noise, random);
  EXPECT_NEAR(reference.scale(), std::sqrt(3.), 0.01);
  EXPECT_NEAR(reference.noise(), noise, 1e-3);
  EXPECT_LT(reference.resolution(), 0.3 * noise);
  for (const double off : {0.0, 0.01, 0.05}) {
    StudyValues values;
    for (std::size_t k = 0; k < 4000; ++k) {
      values.direct.push_back(Rgb::Constant(0.6));
      values.irradiance.push_back(Rgb::Constant(1 + (k % 2 ? off : -off)));
    }
    StudyRow row;
    fill_errors(reference, values, row);
    EXPECT_EQ(row.direct.l2, 0);
    if (off > reference.resolution()) {
      EXPECT_NEAR(row.total.l2, off, 0.15 * off);
    } else {
      EXPECT_EQ(row.total.l2, reference.resolution());
    }
    EXPECT_NEAR(row.total.l2, row.reflected.l2, 1e-12);
    EXPECT_GT(row.total.max, off);
  }
}

TEST(StudyReference, LiesOnAllSurfacesByArea) {
  // A box of 1 × 2 × 3 whose walls all emit: exact direct light, and walks.
  Scene scene = test::room(
      {1, 2, 3}, {{{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}}});
  const PreparedScene prepared(scene);
  const auto reference = find_reference(prepared, {440, 64}, {});
  ASSERT_TRUE(reference);
  int on_floor = 0;
  for (const SurfacePoint& p : reference->points.points) {
    on_floor += p.position.z() == 0 && p.normal.z() == 1;
    EXPECT_TRUE((p.position.array() > -1e-12).all());
  }
  EXPECT_NEAR(on_floor, 440 * 2 / 22, 1) << "stratified";
  Rgb direct = Rgb::Zero(), all = Rgb::Zero();
  for (std::size_t k = 0; k < 440; ++k) {
    direct += reference->direct[k] / 440;
    all += (reference->direct[k] + reference->reflected[k]) / 440;
  }
  EXPECT_NEAR(direct[0], 0.5, 1e-12) << "walls that emit all the same";
  EXPECT_NEAR(all[1], 1, 0.02);

  const test::TempDir folder;
  const auto path = folder.path() / "r.csv";
  write_reference(*reference, "key", path);
  const StudyReference back = read_reference("key", path);
  EXPECT_TRUE((back.reflected[7] == reference->reflected[7]).all());
  EXPECT_TRUE((back.reflected_error[7] == reference->reflected_error[7]).all());
  EXPECT_EQ(back.points.points[7].position, reference->points.points[7].position);
  test::expect_error([&] { read_reference("other", path); }, ErrorCode::usage, {"another study"});
  write_places(*reference, folder.path() / "p.csv");
  EXPECT_EQ(read_points(folder.path() / "p.csv").points.size(), 440u);
}

TEST(StudyReference, OfDirectLightIsExact) {
  const PreparedScene prepared(test::table_scene());
  StudyReferenceOptions options;
  options.points = 50;
  options.direct_only = true;
  const auto reference = find_reference(prepared, options, {});
  ASSERT_TRUE(reference);
  EXPECT_EQ(reference->noise(), 0);
  EXPECT_EQ(reference->resolution(), 0);
}

}  // namespace
}  // namespace halfshade
