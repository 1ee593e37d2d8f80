#include "solver/pipeline/solve_mesh.h"

#include "meshing/core/error.h"
#include "meshing/core/light_source.h"
#include "meshing/patches/quality.h"
#include "meshing/repair/repair.h"
#include "solver/pipeline/fewest_elements.h"
#include "solver/pipeline/limits.h"
#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"
#include "tests/support/expect_error.h"
#include "tests/support/has_warning.h"
#include "tests/support/scenes.h"
#include "tests/support/triangle_soups.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr int floor_of_s1 = 2;  // face

/// S1: a light of 1 × 1 at z = 2 over an occluder of 0.75 × 0.75 at z = 1 over a floor.
Scene s1() {
  Scene scene;
  const int dark = test::add_material(scene, 0, 0), light = test::add_material(scene, 0, 1);
  const auto square = [](double low, double high, double z) {
    return std::vector<Vec3>{{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}};
  };
  test::add_polygon(scene, {{-.5, -.5, 2}, {-.5, .5, 2}, {.5, .5, 2}, {.5, -.5, 2}}, light);
  test::add_polygon(scene, square(-0.375, 0.375, 1), dark);
  test::add_polygon(scene, square(-1.9371, 1.8613, 0), dark);
  return scene;
}

/// Slats between light and floor, none parallel to another: many lines, of many sizes.
Scene slats(int count) {
  Scene scene = s1();
  scene.faces.erase(scene.faces.begin() + 1);
  const int dark = scene.faces.back().material;
  for (int k = 0; k < count; ++k) {
    const double x = -0.5 + k / (count - 1.), turn = 0.03 * std::sin(5. * k);
    test::add_polygon(
        scene, {{x, -.5, 1}, {x + .03, -.5, 1}, {x + turn + .03, .5, 1.1}, {x + turn, .5, 1.1}},
        dark);
  }
  return scene;
}

struct Found {
  SoundScene scene;
  Discontinuities curves;
  double mean = 0;
};

Found find(const Scene& scene) {
  Found found;
  found.scene = make_sound(scene);
  found.curves =
      find_discontinuities(found.scene, OpaqueScene(found.scene), light_sources(found.scene));
  found.mean = mean_direct_irradiance(PreparedScene(scene));
  return found;
}

SolveMesh mesh_along(const Found& found, const SolveOptions& options) {
  return make_solve_mesh(found.scene, found.curves, make_solve_mesh(found.scene, options), options,
                         found.mean);
}

TEST(SolveMesh, HasAboutAsManyElementsAsAskedFor) {
  const Found found = find(s1());
  for (const int elements : {200, 700, 3000}) {
    SolveOptions options = with_limits({}, 10);
    options.method = SolveMethod::matrix;
    options.elements = elements;
    const SolveMesh mesh = mesh_along(found, options);
    EXPECT_LE(mesh.elements.count(), elements);
    EXPECT_GE(mesh.elements.count(), 0.7 * elements)
        << "a square is halved again and again, so that not every number is there";
    EXPECT_EQ(mesh.tolerance, options.tolerance);
    EXPECT_EQ(mesh.report.kept + mesh.report.culled, found.curves.curves.size());
  }
}

TEST(SolveMesh, LeavesOutLinesWhereTheyMakeTooManyElements) {
  const Found found = find(slats(8));
  SolveOptions options = with_limits({}, 10);
  options.method = SolveMethod::matrix;
  options.elements = 100;
  const SolveMesh few = mesh_along(found, options);
  // Ten narrow polygons take more than that without any line.
  const int plain = make_solve_mesh(found.scene, options).elements.count();
  EXPECT_LE(few.elements.count(), std::max(plain, 100));
  EXPECT_GT(few.tolerance, options.tolerance);
  EXPECT_GT(few.report.culled, 0u);
  options.elements = 6500;
  const SolveMesh many = mesh_along(found, options);
  EXPECT_EQ(many.tolerance, options.tolerance);
  EXPECT_GT(many.report.kept, few.report.kept);
}

std::string excess_of(const SolveResult& result) {
  for (const Warning& warning : result.warnings)
    if (warning.kind == Warning::Kind::elements_exceeded) return warning.sentence;
  return "";
}

TEST(SolveMesh, KeepsToTheElementsAskedForOrSaysWhatItTakes) {
  for (const Scene& scene : {s1(), slats(8), slats(30), test::table_scene()})
    for (const SolveMethod method : {SolveMethod::fields, SolveMethod::matrix})
      for (const int asked : {20, 70, 200, 500}) {
        SolveOptions options;
        options.method = method;
        options.refine = Refinement::uniform;
        options.elements = asked;
        options.tolerance = 0.05;
        const SolveResult result = solve(scene, options);
        const int count = result.elements.count();
        const std::string excess = excess_of(result);
        EXPECT_EQ(count > asked, !excess.empty()) << count << " of " << asked << excess;
        const std::string says = fmt::format("take {} elements", count);
        EXPECT_TRUE(excess.empty() || excess.find(says) != std::string::npos) << count << excess;
      }
}

TEST(SolveMesh, HasTheFewestElementsThereCanBeIfThereMayBeNoMore) {
  for (const Scene& scene : {s1(), slats(8), slats(30)}) {
    const SoundScene sound = make_sound(scene);
    SolveOptions options = with_limits({}, 10);
    options.elements = options.max_elements = fewest_elements(sound).count();
    EXPECT_EQ(make_solve_mesh(sound, options).elements.count(), options.max_elements);
    --options.max_elements;
    test::expect_error([&] { make_solve_mesh(sound, options); }, ErrorCode::too_large,
                       {"surfaces with", "--max-elements"});
  }
}

TEST(SolveMesh, MoreElementsAskedForThanThereMayBeAreRefusedAsThat) {
  for (const SolveMethod method : {SolveMethod::fields, SolveMethod::matrix}) {
    SolveOptions options = with_limits({}, 10);
    options.method = method;
    options.refine = Refinement::uniform;
    options.elements = 1000;
    options.max_elements = 20;
    test::expect_error([&] { solve(s1(), options); }, ErrorCode::too_large,
                       {"1000 elements are asked for", "there may be 20"});
  }
}

TEST(SolveMesh, KeepsToTheLengthAskedFor) {
  const Found found = find(s1());
  SolveOptions options = with_limits({}, 10);
  options.method = SolveMethod::matrix;
  options.max_length = 0.2;
  const SolveMesh mesh = mesh_along(found, options);
  EXPECT_LE(summarize_quality(mesh.elements).longest_edge, 0.2);
  options.max_elements = 100;
  test::expect_error([&] { mesh_along(found, options); }, ErrorCode::too_large, {"100"});
}

/// Area of the floor's elements that are wholly dark, and of those that are partly so.
std::pair<double, double> umbra_area(const SolveResult& result) {
  double umbra = 0, cut = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    const auto k = static_cast<std::size_t>(e);
    if (result.elements.face[k] != floor_of_s1) continue;
    int inside = 0;
    for (const Vec3& p : result.elements.triangle(e))
      inside += std::max(std::abs(p.x()), std::abs(p.y())) < 0.25 + 1e-6;
    if (result.solution.direct_irradiance(e, 0) == 0) umbra += result.elements.area[k];
    if (inside > 0 && inside < 3) cut += result.elements.area[k];
  }
  return {umbra, cut};
}

TEST(SolveWithLines, TheUmbraIsItsElements) {
  SolveOptions options = with_limits({}, 10);
  options.method = SolveMethod::matrix;
  options.elements = 500;
  const SolveResult with = solve(s1(), options);
  EXPECT_NEAR(umbra_area(with).first, 0.25, 1e-9) << "0.5 × 0.5, exactly";
  EXPECT_GT(with.curves, 0u);
  EXPECT_GT(with.mesh.kept, 0u);
  options.discontinuities = false;
  const SolveResult without = solve(s1(), options);
  EXPECT_LT(umbra_area(without).first, 0.24);
  EXPECT_EQ(without.curves, 0u);
}

std::string left_out(const SolveResult& result, const std::string& stage) {
  for (const StageReport& report : result.stages)
    if (report.name == stage) return report.left_out_because;
  return "no such stage";
}

TEST(SolveWithLines, AreLeftOutWhereTheyAreNeedless) {
  SolveOptions options = with_limits({}, 10);
  options.method = SolveMethod::matrix;
  options.elements = 100;
  EXPECT_EQ(left_out(solve(s1(), options), "discontinuities"), "");
  const Scene empty =
      test::room({1, 1, 1}, {{{.5, 1}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}}});
  EXPECT_EQ(left_out(solve(empty, options), "discontinuities"),
            "no surface can come between two others");
  Scene furnace = test::l_room(true);
  for (Material& material : furnace.materials) material.exitance = Rgb::Constant(0.5);
  EXPECT_NE(left_out(solve(furnace, options), "discontinuities").find("most surfaces emit"),
            std::string::npos);
  options.discontinuities = false;
  EXPECT_EQ(left_out(solve(s1(), options), "discontinuities"), "they were not asked for");
  options.discontinuities = true;
  options.events = {false, false, false, false};
  EXPECT_EQ(left_out(solve(s1(), options), "discontinuities"), "they were not asked for");
}

TEST(SolveWithLines, SecondarySourcesAddLines) {
  Scene scene = s1();
  for (Material& material : scene.materials) material.rho = Rgb::Constant(0.8);
  // A wall that the floor lights.
  test::add_polygon(scene,
                    {{1.8613, -1.9, 0.1}, {1.8613, -1.9, 2}, {1.8613, 1.8, 2}, {1.8613, 1.8, 0.1}},
                    scene.faces.back().material);
  SolveOptions options = with_limits({}, 10);
  options.method = SolveMethod::matrix;
  options.elements = 300;
  const std::size_t without = solve(scene, options).curves;
  options.secondary = 1;
  EXPECT_GT(solve(scene, options).curves, without);
}

TEST(SolveWithLines, RefusesOptionsOutOfRange) {
  SolveOptions negative, none;
  negative.tolerance = -0.1;
  none.secondary = -1;
  for (const SolveOptions& options : {negative, none})
    test::expect_error([&] { solve(s1(), options); }, ErrorCode::contract,
                       {"solve", "not negative"});
}

TEST(SolveWithLines, RefusesAtOnceWhatTakesTooManyElements) {
  Scene scene = slats(30);
  SolveOptions options = with_limits({}, 10);
  options.method = SolveMethod::matrix;
  options.max_elements = 20;
  test::expect_error([&] { solve(scene, options); }, ErrorCode::too_large,
                     {"more than 20", "--max-elements"});
}

TEST(SolveWithLines, SaysWhatTheElementsAskedForDoNotDo) {
  SolveOptions options = with_limits({}, 10);
  options.method = SolveMethod::matrix;
  options.elements = 30;
  const SolveResult result = solve(slats(8), options);
  EXPECT_LE(result.elements.count(), make_solve_mesh(result.scene, options).elements.count());
  EXPECT_TRUE(test::has_warning(result, Warning::Kind::tolerance_raised));
}

TEST(SolveWithLines, ThinLouvresStayWithinTheElementsAskedFor) {
  Scene scene = s1();
  const int dark = test::add_material(scene, 0, 0);
  for (int k = 0; k < 12; ++k) {
    const double x = -0.9 + 0.15 * k;
    for (const auto& face : test::box_faces({x, -0.9, 0.8}, {x + 0.01, 0.9, 0.9}, false))
      test::add_polygon(scene, face, dark);
  }
  for (const SolveMethod method : {SolveMethod::fields, SolveMethod::matrix}) {
    SolveOptions options = with_limits({}, 10);
    options.method = method;
    options.refine = Refinement::uniform;
    for (const int asked : {300, 1000}) {
      options.elements = asked;
      const SolveResult result = solve(scene, options);
      EXPECT_LE(result.elements.count(), asked);
      EXPECT_GE(result.elements.count(), 0.6 * asked);
      EXPECT_LT(result.mesh.kept, result.curves);
      EXPECT_TRUE(test::has_warning(result, Warning::Kind::tolerance_raised) ||
                  test::has_warning(result, Warning::Kind::curves_left_out));
    }
  }
}

TEST(SolveWithLines, ContactLinesAreLeftOutWhereTheyTakeTooManyElements) {
  const Scene soup = test::unit_soup(40, 2);
  SolveOptions options = with_limits({}, 10);
  options.method = SolveMethod::matrix;
  options.elements = 400;
  options.max_elements = 1000;
  options.events.most_work = 300;
  const SolveResult result = solve(soup, options);
  EXPECT_TRUE(test::has_warning(result, Warning::Kind::contacts_left_out));
  for (const Surface& surface : result.scene.surfaces) EXPECT_TRUE(surface.contacts.empty());
  EXPECT_LE(result.elements.count(), 1000);
  EXPECT_GT(result.solution.irradiance.maxCoeff(), 0);
  options.max_elements = 30;
  test::expect_error([&] { solve(soup, options); }, ErrorCode::too_large,
                     {"40 surfaces", "--max-elements"});
}

TEST(SolveWithLines, SoupsAreSolvedAndSayWhatIsLeftOut) {
  for (const Scene& scene : {test::unit_soup(15, 1), test::grid_soup(12, 3, 1)}) {
    SolveOptions options = with_limits({}, 10);
    options.method = SolveMethod::matrix;
    options.elements = 500;
    options.events.most_work = 300;
    const SolveResult result = solve(scene, options);
    EXPECT_GT(result.solution.irradiance.maxCoeff(), 0);
    EXPECT_TRUE(result.solution.irradiance.allFinite());
    EXPECT_GT(*std::max_element(result.discontinuities.left_out.begin(),
                                result.discontinuities.left_out.end()),
              0);
    EXPECT_TRUE(test::has_warning(result, Warning::Kind::curves_left_out));
    EXPECT_TRUE(test::has_warning(result, Warning::Kind::elements_exceeded) ||
                result.elements.count() <= options.elements);
    EXPECT_TRUE(test::has_warning(result, Warning::Kind::tolerance_raised) ||
                result.discontinuity_tolerance <= options.tolerance);
  }
}

}  // namespace
}  // namespace halfshade
