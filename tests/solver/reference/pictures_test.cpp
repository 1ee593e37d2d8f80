#include "meshing/core/error.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "solver/reference/classic_picture.h"
#include "solver/reference/reference_picture.h"
#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace halfshade {
namespace {

constexpr double pi = std::numbers::pi;

/// Looks from a point at another one, a square of `width` at its distance.
CameraRays looking(const Vec3& from, const Vec3& to, double width, int pixels) {
  const Vec3 forward = to - from;
  const PlaneFrame frame = make_frame(from, -forward.normalized());
  const Vec3 right = width / pixels * frame.e1, down = -width / pixels * frame.e2;
  return {from, forward - 0.5 * pixels * (right + down), right, down, pixels, pixels, 0, 1};
}

/// One small pixel.
Rgb radiance_at(const SoundScene& scene, const Vec3& from, const Vec3& to,
                const ClassicOptions& options, int samples = 4096) {
  return classic_picture(scene, looking(from, to, 1e-6, 1), options, {.samples = samples})
      .radiance.front();
}

ClassicOptions without_ambient(ClassicShadows shadows) {
  ClassicOptions options;
  options.shadows = shadows;
  options.ambient = 0;
  return options;
}

TEST(ReferencePicture, OfAFurnaceIsEvenWithinItsStandardErrors) {
  const SoundScene scene = make_sound(
      test::room({1, 1, 1}, {{{.5, .5}, {.2, .8}, {.7, .3}, {.4, .6}, {.9, .1}, {.3, .7}}}));
  const TracedPicture picture = reference_picture(scene, looking({.2, .3, .4}, {.9, .8, .5}, 1, 16),
                                                  {.samples = 64, .batches = 16});
  ASSERT_TRUE(picture.complete);
  EXPECT_EQ(picture.samples, 64);
  int far = 0;
  double sum = 0;
  for (std::size_t k = 0; k < picture.radiance.size(); ++k) {
    const double off = picture.radiance[k][0] - 1 / pi, error = picture.standard_error[k][0];
    far += std::abs(off) > 3 * error + 1e-12;
    sum += off;
    EXPECT_LT(std::abs(off), 6 * error + 1e-12);
    EXPECT_EQ(picture.emits[k], 1);
  }
  // Student's distribution with 15 degrees: beyond 3 with a probability of .009.
  EXPECT_LE(far, 10);
  const double count = static_cast<double>(picture.radiance.size());
  EXPECT_LT(std::abs(sum / count), 4 * picture.relative_error() / pi / std::sqrt(count));
  EXPECT_GT(picture.relative_error(), 0);
}

TEST(ReferencePicture, PixelsAtAnEdgeHoldTheShareThatIsSeen) {
  SoundScene scene;
  {
    Scene raw;
    test::add_polygon(raw, {{0, -5, 0}, {5, -5, 0}, {5, 5, 0}, {0, 5, 0}},
                      test::add_material(raw, 0, 2));
    scene = make_sound(raw);
  }
  // The light's edge x = 0 cuts the middle one of three pixels at 0.3 of its width.
  const TracedPicture picture =
      reference_picture(scene, looking({0.2, 0, 10}, {0.2, 0, 0}, 3, 3), {.samples = 256});
  std::vector<double> shares;
  for (const Rgb& radiance : picture.radiance) shares.push_back(radiance[0] * pi / 2);
  std::sort(shares.begin(), shares.end());
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(shares[k], 0, 1e-12);
    EXPECT_NEAR(shares[k + 3], 0.7, 0.01);
    EXPECT_NEAR(shares[k + 6], 1, 1e-12);
  }
}

TEST(TracedPicture, ALensBlursWhatIsNotInFocusByItsDisc) {
  Scene raw;
  test::add_polygon(raw, {{0, -50, 0}, {50, -50, 0}, {50, 50, 0}, {0, 50, 0}},
                    test::add_material(raw, 0, 1));
  const SoundScene scene = make_sound(raw);
  // One pixel, its axis 0.2 from the light's edge, which is at a distance of 10.
  CameraRays camera = looking({0.2, 0, 10}, {0.2, 0, 9}, 1e-6, 1);
  camera.lens = 0.5;
  const auto share = [&](double focus) {
    camera.focus = focus;
    return reference_picture(scene, camera, {.samples = 8192}).radiance.front()[0] * pi;
  };
  EXPECT_NEAR(share(10), 1, 1e-12) << "in focus the edge is sharp";
  for (const double focus : {4., 6., 25.}) {
    // The lens' disc as seen there; the share of it beyond a chord.
    const double t = std::min(1., 0.2 / (0.5 * std::abs(10 / focus - 1)));
    EXPECT_NEAR(share(focus), 0.5 + (std::asin(t) + t * std::sqrt(1 - t * t)) / pi, 2e-3) << focus;
  }
}

/// How much of [0, 1] + `late` · [0, 1] lies below a number: the share of a pixel's width and the
/// shutter's time together.
double trapezoid(double x, double late) {
  const auto ramp = [](double t) { return 0.5 * std::pow(std::max(0., t), 2); };
  return (ramp(x) - ramp(x - 1) - ramp(x - late) + ramp(x - 1 - late)) / late;
}

TEST(TracedPicture, AMoveBlursEdgesByTheTimeTheyAreSeen) {
  Scene raw;
  test::add_polygon(raw, {{0, -50, 0}, {50, -50, 0}, {50, 50, 0}, {0, 50, 0}},
                    test::add_material(raw, 0, 1));
  const SoundScene scene = make_sound(raw);
  const auto share = [&](CameraRays camera, const Vec3& move) {
    camera.move = move;
    const TracedPicture picture = reference_picture(scene, camera, {.samples = 8192});
    return picture.radiance.front()[0] * pi;
  };
  // One thin ray: it is over the light from 0.3 / 0.8 of the time on.
  const CameraRays thin = looking({-0.3, 0, 10}, {-0.3, 0, 9}, 1e-9, 1);
  EXPECT_NEAR(share(thin, {0.8, 0, 0}), 1 - 0.3 / 0.8, 1e-3);
  EXPECT_EQ(share(thin, {0, 5, 5}), 0) << "along the edge, and back";
  // Aslant: forwards by z it meets the plane nearer, x = 0.7 − 0.1 z t.
  const CameraRays aslant = looking({-0.3, 0, 10}, {0.7, 0, 0}, 1e-9, 1);
  EXPECT_NEAR(share(aslant, {0, 0, -6.9}), 1, 1e-12);
  EXPECT_NEAR(share(aslant, {0, 0, -9.5}), 7 / 9.5, 1e-3);
  // A pixel 0.5 wide on the plane, from -0.6 to -0.1, and a move by 0.4: both blur.
  const CameraRays wide = looking({-0.35, 0, 10}, {-0.35, 0, 0}, 0.5, 1);
  EXPECT_NEAR(share(wide, {0.4, 0, 0}), 1 - trapezoid(0.6 / 0.5, 0.4 / 0.5), 2e-3);
  // A lens is carried along, and its focus.
  CameraRays lens = thin;
  lens.lens = 0.5;
  lens.focus = 10;
  EXPECT_NEAR(share(lens, {0.8, 0, 0}), 1 - 0.3 / 0.8, 2e-3);
}

TEST(ClassicPicture, SoftShadowsAreTheDirectLight) {
  const SoundScene scene = make_sound(test::table_scene());
  const DirectLightIndex exact(scene);
  for (const Vec3& place : {Vec3(.9, .2, 0), Vec3(.4, .3, 0), Vec3(-.3, .6, 0), Vec3(0, 0, 0)}) {
    const double H = exact.irradiance({place, {0, 0, 1}}).irradiance[0];
    const Rgb seen =
        radiance_at(scene, {3, 3, .5}, place, without_ambient(ClassicShadows::soft), 16384);
    EXPECT_NEAR(seen[0], 0.5 * H / pi, 0.01 * 0.5 * 0.24 / pi) << place.transpose();
  }
}

TEST(ClassicPicture, HardShadowsEndAtOnce) {
  const SoundScene scene = make_sound(test::table_scene());
  const ClassicOptions options = without_ambient(ClassicShadows::hard);
  // The table's half width of .25 at 1 under a point at 2 makes .5 on the floor.
  EXPECT_EQ(radiance_at(scene, {3, 3, .5}, {.49, .2, 0}, options)[0], 0);
  const double r2 = .51 * .51 + .2 * .2 + 4, H = 4 / (pi * r2 * r2);
  EXPECT_NEAR(radiance_at(scene, {3, 3, .5}, {.51, .2, 0}, options)[0], .5 * H / pi, 1e-6);
  EXPECT_NEAR(
      radiance_at(scene, {3, 3, .5}, {.51, .2, 0}, without_ambient(ClassicShadows::none))[0],
      .5 * H / pi, 1e-6);
  EXPECT_GT(radiance_at(scene, {3, 3, .5}, {.49, .2, 0}, without_ambient(ClassicShadows::none))[0],
            0);
}

TEST(ClassicPicture, MirrorsShowWhatTheyFaceAndHighlightsWhereTheLightIs) {
  const SoundScene scene = make_sound(test::table_scene());
  ClassicOptions options = without_ambient(ClassicShadows::hard);
  options.mirrors = {true};
  // Mirrored at (.8, 0, 0) the sight from (1.4, 0, 1.9) is at x = .17 at the light's height.
  EXPECT_NEAR(radiance_at(scene, {1.4, 0, 1.9}, {.8, 0, 0}, options)[0], 1 / pi, 1e-9);
  EXPECT_EQ(radiance_at(scene, {1.9, 0, .5}, {.8, 0, 0}, options)[0], 0) << "past the light";
  options.mirrors.clear();
  options.highlight = 0.3;
  options.exponent = 50;
  const double r2 = .8 * .8 + 4, H = 4 / (pi * r2 * r2);
  EXPECT_NEAR(radiance_at(scene, {1.6, 0, 2}, {.8, 0, 0}, options)[0],
              H * (.5 / pi + .3 * 52 / (2 * pi)), 1e-5);
  EXPECT_NEAR(radiance_at(scene, {.8, 1.5, .2}, {.8, 0, 0}, options)[0], H * .5 / pi, 1e-5);
}

TEST(ClassicPicture, TheAmbientTermIsTheMeanOfReflectedLightInAClosedRoomOfOneReflectance) {
  const SoundScene scene = make_sound(test::lit_cube({.6, .6, .6, .6, .6, .6}));
  // Mean irradiance Φ / (A (1 − ρ)), of which Φ / A is direct.
  EXPECT_NEAR(evenly_spread_light(scene)[0], 1. / 6 / .4 - 1. / 6, 1e-12);
  ClassicOptions options = without_ambient(ClassicShadows::soft);
  const double direct = radiance_at(scene, {.5, .5, .5}, {.5, .5, 0}, options)[0];
  options.ambient = 2;
  EXPECT_NEAR(radiance_at(scene, {.5, .5, .5}, {.5, .5, 0}, options)[0], direct + .6 * 2 / pi,
              1e-12);
}

TEST(TracedPicture, WrongOptionsAreRefused) {
  const SoundScene scene = make_sound(test::table_scene());
  const CameraRays camera = looking({3, 3, 1}, {0, 0, 0}, 1, 2);
  test::expect_error([&] { reference_picture(scene, camera, {.samples = 0}); }, ErrorCode::contract,
                     {"0 samples"});
  CameraRays lost = camera;
  lost.move.x() = std::numeric_limits<double>::infinity();
  test::expect_error([&] { reference_picture(scene, lost, {}); }, ErrorCode::contract, {"move"});
  ClassicOptions options;
  options.exponent = 0;
  test::expect_error([&] { classic_picture(scene, camera, options, {}); }, ErrorCode::contract,
                     {"exponent 0"});
}

}  // namespace
}  // namespace halfshade
