// Is the accuracy given that was asked for, and at what cost? Direct light of scenes in data/, with
// curves (as solve decides) and without, for tolerances from 1e-2 to 1e-6, and without by elements
// of one order: elements, unknowns, estimated and true error (exact values at random points),
// seconds. Then of random scenes, 50 of convex occluders and 50 of lights and things that touch or
// nearly do: how many were reached, how far the error of those was from the tolerance, and from the
// estimate (a fine rule on each element, since random points do not find what is wrong in a
// corner).

#include "io/read/read_scene.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/solve.h"
#include "tests/support/places.h"
#include "tests/support/random.h"
#include "tests/support/touching_lights.h"
#include "tests/support/true_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace halfshade {
namespace {

/// Random points that tell what is true: of ten thousand, one in the corner of a bar's shadow may
/// count for as much as all others. Where a point takes milliseconds, fewer must do.
constexpr int many_points = 100000, few_points = 10000;
constexpr std::size_t many_faces = 500;
/// Where elements of one order without curves do not take minutes.
constexpr std::size_t few_faces = 4;

/// Relative L2 error of the polynomials, at points spread evenly over the area.
double true_error(const SolveResult& result) {
  const DirectLightIndex index(result.scene);
  std::vector<double> sums;
  double area = 0;
  for (const double a : result.elements.area) sums.push_back(area += a);
  test::Random random(1);
  const int points = result.scene.surfaces.size() > many_faces ? few_points : many_points;
  std::vector<SurfacePoint> from;
  std::vector<Rgb> fitted;
  for (int k = 0; k < points; ++k) {
    const double at_area = (k + random(0, 1)) / points * area;
    const auto found = std::lower_bound(sums.begin(), sums.end() - 1, at_area);
    const int e = static_cast<int>(found - sums.begin());
    TrianglePlace place(random(0, 1), random(0, 1));
    if (place.sum() > 1) place = TrianglePlace(1, 1) - place;
    from.push_back({position(result.elements.triangle(e), place), result.elements.normal[at(e)]});
    fitted.push_back(value_at(result.direct, e, place));
  }
  const std::vector<DirectLight> light = index.irradiance(from);
  double square_error = 0, square = 0;
  for (std::size_t k = 0; k < light.size(); ++k) {
    square_error += (fitted[k] - light[k].irradiance).matrix().squaredNorm();
    square += light[k].irradiance.matrix().squaredNorm();
  }
  return std::sqrt(square_error / square);
}

SolveOptions options_for(double tolerance) {
  SolveOptions options;
  options.tolerance = tolerance;
  options.radiosity.bounces = 0;
  options.max_elements = 200000;
  options.max_unknowns = 4000000;
  return options;
}

/// `order` of all elements, −1: each has its own.
void measure(const std::string& name, const Scene& scene, double tolerance, bool with_curves,
             int order = -1) {
  SolveOptions options = options_for(tolerance);
  options.discontinuities = with_curves;
  options.order = order;
  const auto start = std::chrono::steady_clock::now();
  const SolveResult result = solve(scene, options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const double error = true_error(result);
  fmt::print("{},{:.0e},{}{},{},{},{:.3g},{:.3g},{:.2f},{:.2f},{}\n", name, tolerance,
             with_curves ? (result.curves > 0 ? "followed" : "not worth it") : "left out",
             order < 0 ? "" : fmt::format(" (order {})", order), result.elements.count(),
             result.refinement.unknowns, result.relative_error, error,
             result.relative_error / error, elapsed.count(),
             result.not_reached.empty() ? "reached" : "limit");
}

double fine_error(const SolveResult& result) {
  const DirectLightIndex index(result.scene);
  double error = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    const auto triangle = result.elements.triangle(e);
    error +=
        result.elements.area[at(e)] * test::triangle_mean(1, [&](const TrianglePlace& place) {
          const SurfacePoint point = {position(triangle, place), result.elements.normal[at(e)]};
          const Rgb exact = index.irradiance(point).irradiance;
          return (value_at(result.direct, e, place) - exact).matrix().squaredNorm();
        });
  }
  return std::sqrt(error / square_integral(result.direct, result.elements));
}

void measure_random(const char* name, Scene (*make)(std::uint64_t), double tolerance) {
  constexpr int seeds = 50;
  int reached = 0, close = 0;
  double worst = 0, least = 1e300, most = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const SolveResult result =
        solve(make(static_cast<std::uint64_t>(seed)), options_for(tolerance));
    if (!result.not_reached.empty()) continue;
    const double error = fine_error(result), ratio = result.relative_error / error;
    ++reached;
    worst = std::max(worst, error / tolerance);
    least = std::min(least, ratio);
    most = std::max(most, ratio);
    if (ratio >= 1 && ratio <= 3) ++close;
  }
  fmt::print("{},{:.0e},{},{},{:.2f},{},{:.2f},{:.2f}\n", name, tolerance, seeds, reached, worst,
             close, least, most);
}

}  // namespace
}  // namespace halfshade

int main(int argc, char** argv) {
  using namespace halfshade;
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // it takes minutes
  fmt::print("scene,tolerance,curves,elements,unknowns,estimated,true,ratio,seconds,outcome\n");
  std::vector<std::string> names(argv + 1, argv + argc);
  const bool is_all = names.empty();
  if (is_all)
    names = {"s1", "bars", "skew_bars", "table_and_chairs", "holed_light", "hundred_lights"};
  for (const std::string& name : names) {
    const Scene scene =
        read_scene(std::filesystem::path(test::data_folder) / (name + ".obj")).scene;
    // A hundred lights over a thousand things take minutes to 1 % and hours to less.
    const double least = scene.faces.size() > many_faces ? 5e-3 : 0;
    for (const bool with_curves : {true, false})
      for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
        if (tolerance > least && (with_curves || tolerance > 5e-5))
          measure(name, scene, tolerance, with_curves);
    if (scene.faces.size() <= few_faces)
      for (const int order : {1, 2, 3, 4, 5}) measure(name, scene, 1e-4, false, order);
  }
  if (!is_all) return 0;
  fmt::print(
      "\nscenes,tolerance,number,reached,worst true / asked,estimate within 1 to 3 times,"
      "least estimate / true,most\n");
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
    measure_random("convex occluders", test::convex_occluders, tolerance);
  for (const double tolerance : {1e-2, 1e-3, 1e-4})
    measure_random("touching lights", test::touching_light, tolerance);
}
