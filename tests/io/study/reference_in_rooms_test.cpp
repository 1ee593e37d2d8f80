// Random walks against solutions of whole rooms: they share nothing but the scene and its rays.
// HALFSHADE_ROOMS=n takes n times as many points, and solves n times as exactly:
//   HALFSHADE_ROOMS=4 build/release/tests/io_tests --gtest_filter='*ReferenceInRooms*'

#include "io/read/read_scene.h"
#include "io/study/study_reference.h"
#include "solver/pipeline/light_at_points.h"
#include "solver/pipeline/solve.h"
#include "solver/pipeline/surface_finder.h"
#include "solver/reference/reference_light.h"
#include "tests/support/files.h"
#include "tests/support/fuzz_settings.h"
#include "tests/support/z_scores.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace halfshade {
namespace {

struct Room {
  std::string name;
  double tolerance;
  int points, samples;
  int elements;          ///< whose means are looked at: more where one in a hundred is far off
  bool gathers_exactly;  ///< what is gathered is far more exact than walks are
};

void PrintTo(const Room& room, std::ostream* out) { *out << room.name; }

/// A room, its light by random walks, and its solution.
struct SolvedRoom {
  Room room;
  PreparedScene prepared;
  StudyReference walks;
  SolveResult result;

  const std::vector<SurfacePoint>& points() const { return walks.points.points; }
};

SolvedRoom solved(Room room) {
  const int more = test::fuzz_setting("HALFSHADE_ROOMS", 1);
  room.tolerance /= more;
  room.points *= more;
  // So many tell the solution's own error from none.
  room.gathers_exactly = room.gathers_exactly && more == 1;
  PreparedScene prepared(read_scene(test::data_file(room.name + ".obj")).scene);
  StudyReference walks = *find_reference(prepared, {room.points, room.samples}, {});
  SolveOptions options;
  options.tolerance = room.tolerance;
  SolveResult result = solve(prepared, options);
  return {room, std::move(prepared), std::move(walks), std::move(result)};
}

/// The solution is no farther off than both errors together, nor is its mean.
void expect_within_errors(const SolvedRoom& solved) {
  const StudyReference& walks = solved.walks;
  StudyValues values;
  Rgb off = Rgb::Zero(), all = Rgb::Zero(), variance = Rgb::Zero();
  for (const PointLight& light : light_at_points(solved.result, solved.points())) {
    const std::size_t k = values.direct.size();
    values.irradiance.push_back(light.irradiance);
    values.direct.push_back(light.direct_irradiance);
    off += light.irradiance - walks.direct[k] - walks.reflected[k];
    all += light.irradiance;
    variance += walks.reflected_error[k].square();
  }
  StudyRow row;
  fill_errors(walks, values, row);
  const double estimated = solved.result.relative_error;
  EXPECT_LE(estimated, solved.room.tolerance);
  EXPECT_LE(row.total.l2, std::hypot(estimated, walks.resolution()));
  EXPECT_LE(row.direct.l2, solved.room.tolerance);
  for (int c = 0; c < 3; ++c)
    EXPECT_LE(std::abs(off[c]), 3.5 * std::sqrt(variance[c]) + estimated * all[c]);
}

/// What is gathered from it is off by as many standard errors of the walks as it should be.
void expect_right_scores(const SolvedRoom& solved) {
  const auto& [room, prepared, walks, result] = solved;
  std::vector<DirectLight> light = prepared.direct_light().irradiance(solved.points());
  const std::vector<FieldPoint> places = on_surfaces(prepared, solved.points());
  ASSERT_TRUE(add_gathered_light(result, room.tolerance, places, light));
  const double own = room.gathers_exactly ? 0 : room.tolerance * walks.scale() / std::sqrt(3.);
  std::vector<double> scores;
  for (std::size_t k = 0; k < light.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k % 3);
    const double error = std::hypot(walks.reflected_error[k][c], own);
    if (error > 0)
      scores.push_back((walks.direct[k][c] + walks.reflected[k][c] - light[k].irradiance[c]) /
                       error);
  }
  EXPECT_GE(scores.size(), 0.9 * static_cast<double>(light.size()));
  if (room.gathers_exactly) {
    test::expect_right_distribution(scores, 31);
    return;
  }
  const auto far =
      std::count_if(scores.begin(), scores.end(), [](double score) { return std::abs(score) > 3; });
  EXPECT_LE(static_cast<double>(far), 0.02 * static_cast<double>(scores.size()));
}

/// Means over elements, some of all sizes, are no farther off than both errors together.
void expect_right_means(const SolvedRoom& solved) {
  const ElementTable& elements = solved.result.elements;
  std::vector<ReferenceTriangle> triangles;
  std::vector<Rgb> means;
  std::vector<double> areas;
  const std::size_t step = elements.corners.size() / at(solved.room.elements) + 1;
  for (std::size_t e = 0; e < elements.corners.size(); e += step) {
    const auto& [a, b, c] = elements.corners[e];
    triangles.push_back({elements.points[at(a)], elements.points[at(b)], elements.points[at(c)]});
    means.emplace_back(solved.result.solution.irradiance.row(static_cast<Eigen::Index>(e)));
    areas.push_back(elements.area[e]);
  }
  const ReferenceLight light =
      reference_means(solved.prepared.scene(), triangles, {.samples = solved.room.samples});
  double excess = 0, spread = 0, all = 0;
  for (std::size_t k = 0; k < means.size(); ++k) {
    const double noise = areas[k] * light.standard_errors[k].total.square().sum();
    excess += areas[k] * (means[k] - light.values[k].total).square().sum() - noise;
    spread += 2 * noise * noise;
    all += areas[k];
  }
  const double claimed = solved.result.relative_error * solved.walks.scale();
  EXPECT_LE(excess, 3 * std::sqrt(spread) + claimed * claimed * all);
}

class ReferenceInRooms : public testing::TestWithParam<Room> {};

TEST_P(ReferenceInRooms, AgreesWithTheSolution) {
  const SolvedRoom room = solved(GetParam());
  expect_within_errors(room);
  expect_right_scores(room);
  expect_right_means(room);
}

// Batches of few walks are skewed, which shifts scores, and few of the points in a dining room see
// most of its error.
INSTANTIATE_TEST_SUITE_P(All, ReferenceInRooms,
                         testing::Values(Room{"cornell_box", 0.005, 200, 8192, 50, true},
                                         Room{"table_and_chairs", 0.01, 200, 1024, 500, false},
                                         Room{"dining_room", 0.15, 4000, 256, 50, false}),
                         [](const auto& room) { return room.param.name; });

}  // namespace
}  // namespace halfshade
