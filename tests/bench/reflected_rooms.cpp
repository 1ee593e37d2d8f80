// Is the accuracy given that was asked for, and at what cost, where light is reflected? All light
// of rooms in data/ and of furnished rooms of some numbers of polygons, against random walks at
// random points, which share nothing with the solution but the scene: estimated and true error of
// the whole and of reflected light, what the walks' own noise hides, and CPU seconds. Then
// furnaces, whose light is known, and goals, against walks and beside solutions for all light.
// Arguments: names of rooms or numbers of polygons, instead of all.

#include "io/read/read_scene.h"
#include "io/study/study_reference.h"
#include "solver/pipeline/light_at_points.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"
#include "solver/reference/reference_light.h"
#include "tests/support/places.h"
#include "tests/support/room_families.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace halfshade {
namespace {

constexpr int points = 3000, samples = 2048, paths_of_goal = 2000000;

double cpu_seconds(const SolveResult& result, std::string_view stage = {}) {
  double sum = 0;
  for (const StageReport& report : result.stages)
    if (stage.empty() || report.name == stage) sum += report.cpu_seconds;
  return sum;
}

/// Root of a mean square, less that of noise; 0 if there is no more.
double without_noise(double square, double noise) {
  return std::sqrt(std::max(square - noise, 0.));
}

void measure(const std::string& name, const PreparedScene& prepared, const StudyReference& walks,
             double tolerance) {
  SolveOptions options;
  options.tolerance = tolerance;
  const SolveResult result = solve(prepared, options);
  double total = 0, reflected = 0, noise = 0;
  const std::vector<PointLight> light = light_at_points(result, walks.points.points);
  for (std::size_t k = 0; k < light.size(); ++k) {
    const Rgb of_reflected = light[k].irradiance - light[k].direct_irradiance - walks.reflected[k];
    reflected += of_reflected.square().sum();
    total += (light[k].irradiance - walks.direct[k] - walks.reflected[k]).square().sum();
    noise += walks.reflected_error[k].square().sum();
  }
  const double scale = std::sqrt(static_cast<double>(light.size())) * walks.scale();
  fmt::print("{},{},{:.2g},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f},{:.2f},{}\n", name,
             prepared.scene().surfaces.size(), tolerance, result.reflected.elements,
             result.relative_error, without_noise(total, noise) / scale, result.reflected.error,
             without_noise(reflected, noise) / scale, std::sqrt(noise) / scale,
             cpu_seconds(result, "reflected light"), cpu_seconds(result),
             result.not_reached.empty() ? "reached" : '"' + result.not_reached + '"');
}

void measure(const std::string& name, const Scene& scene, std::span<const double> tolerances) {
  const PreparedScene prepared(scene);
  const StudyReference walks = *find_reference(prepared, {points, samples}, {});
  for (const double tolerance : tolerances) measure(name, prepared, walks, tolerance);
}

Scene room_named(const std::string& name) {
  const bool is_number = name.find_first_not_of("0123456789") == name.npos;
  if (is_number) return test::furnished_room(std::stoi(name));
  return read_scene(std::filesystem::path(test::data_folder) / (name + ".obj")).scene;
}

/// A closed cube whose walls send out 1 − ρ: all radiosity is 1. They absorb (1 − rho) times 1
/// to 6.
void measure_furnace(double rho) {
  std::array<std::pair<double, double>, 6> walls;
  for (std::size_t k = 0; k < 6; ++k) {
    const double absorbed = (1 - rho) * static_cast<double>(k + 1);
    walls[k] = {1 - absorbed, absorbed};
  }
  SolveOptions options;
  options.tolerance = 1e-3;
  const SolveResult result = solve(test::room({1, 1, 1}, walls), options);
  fmt::print("{},{:.2g},{:.2g},{}\n", rho, (result.solution.radiosity - 1).abs().maxCoeff(),
             result.relative_error, result.reflected.iterations);
}

/// The mean irradiance of one group, and all light, to the same tolerance.
void measure_goal(const std::string& name, const std::string& group, double tolerance) {
  const PreparedScene prepared(room_named(name));
  SolveOptions options;
  options.tolerance = tolerance;
  const SolveResult all = solve(prepared, options);
  options.goal = group;
  const SolveResult goal = solve(prepared, options);
  std::vector<ReferenceTriangle> triangles;
  std::vector<double> areas;
  for (int e = 0; e < all.elements.count(); ++e)
    if (all.elements.group[at(e)] == goal.goal->group) {
      triangles.push_back(all.elements.triangle(e));
      areas.push_back(all.elements.area[at(e)] / goal.goal->area);
    }
  ReferenceOptions walks;
  walks.samples = std::max(walks.samples, paths_of_goal / static_cast<int>(triangles.size()));
  const ReferenceLight reference = reference_means(prepared.scene(), triangles, walks);
  Rgb mean = Rgb::Zero(), variance = Rgb::Zero();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    mean += areas[i] * reference.values[i].total;
    variance += (areas[i] * reference.standard_errors[i].total).square();
  }
  const double scale = mean.matrix().norm();
  const auto unknowns = [](const SolveResult& result) {
    return result.refinement.unknowns + result.reflected.unknowns;
  };
  fmt::print("{},{},{:.2g},{},{},{:.4f},{:.4f},{:.4f},{:.2f},{:.2f}\n", name, group, tolerance,
             unknowns(all), goal.goal->unknowns, goal.relative_error,
             (goal.goal->mean - mean).matrix().norm() / scale, std::sqrt(variance.sum()) / scale,
             cpu_seconds(all), cpu_seconds(goal));
}

}  // namespace
}  // namespace halfshade

int main(int argc, char** argv) {
  using namespace halfshade;
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // it takes minutes
  fmt::print(
      "scene,surfaces,tolerance,elements of reflected light,estimated,true,estimated of reflected,"
      "true of reflected,noise of walks,CPU s of reflected,CPU s,outcome\n");
  std::vector<std::string> names(argv + 1, argv + argc);
  const bool is_all = names.empty();
  if (is_all)
    names = {"cornell_box", "l_room",     "table_and_chairs",
             "dining_room", "mural_room", "67",
             "187",         "600",        "1700",
             "5500"};
  constexpr std::array<double, 3> tolerances = {5e-2, 1.5e-2, 5e-3};
  for (const std::string& name : names) {
    // A room of thousands takes minutes to half a percent.
    const Scene scene = room_named(name);
    const std::size_t count = scene.faces.size() > 150 ? 2 : tolerances.size();
    measure(name, scene, std::span(tolerances).first(count));
  }
  if (!is_all) return 0;
  fmt::print("\nfurnace: reflectance,largest error of B,estimated,iterations\n");
  for (const double rho : {0.85, 0.9, 0.999, 1 - 1e-6, 1 - 1e-12}) measure_furnace(rho);
  fmt::print(
      "\ngoal: scene,group,tolerance,unknowns for all light,for the goal,estimated,true,noise of "
      "walks,CPU s for all,goal\n");
  for (const auto& [name, group] : {std::pair("cornell_box", "tall_block"),
                                    {"table_and_chairs", "light"},
                                    {"table_and_chairs", "table"},
                                    {"dining_room", "chair_3"},
                                    {"dining_room", "window"}})
    for (const double tolerance : {2e-2, 1e-2}) measure_goal(name, group, tolerance);
}
