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
#include "tests/support/scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace halfshade {
namespace {

constexpr int points = 3000, paths_of_goal = 2000000;
/// Random walks from each point: where few thousandths are asked for, noise must not hide them. Of
/// hundreds of reflections there are fewer.
constexpr int fewest_samples = 512, few_samples = 2048, more_samples = 8192, many_samples = 16384;

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

int samples_for(const std::string& name, const Scene& scene) {
  if (name == "close_plates") return fewest_samples;
  if (scene.faces.size() < 150) return many_samples;
  return scene.faces.size() < 500 ? more_samples : few_samples;
}

void measure(const std::string& name, const Scene& scene, std::span<const double> tolerances) {
  const PreparedScene prepared(scene);
  const int samples = samples_for(name, scene);
  const StudyReference walks = *find_reference(prepared, {points, samples}, {});
  for (const double tolerance : tolerances) measure(name, prepared, walks, tolerance);
}

Scene read_data(const std::string& name) {
  return read_scene(std::filesystem::path(test::data_folder) / (name + ".obj")).scene;
}

/// The bars of data/ over their floor, in a room of grey walls and a grey ceiling.
Scene bars_with_walls() {
  Scene scene = read_data("bars");
  const auto faces = test::box_faces({-2.0371, -2.0371, 0}, {1.9613, 1.9613, 3.2}, true);
  const int grey = test::add_material(scene, 0.5, 0);
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (f != 4) test::add_polygon(scene, faces[f], grey);  // 4 is the floor
  return scene;
}

/// A closed cube whose walls send out up to a fifth more or less than would make it a furnace.
Scene uneven_furnace() {
  std::array<std::pair<double, double>, 6> walls;
  for (std::size_t k = 0; k < 6; ++k) {
    const double rho = 0.3 + 0.1 * static_cast<double>(k);
    walls[k] = {rho, (1 - rho) * (1 + 0.08 * (static_cast<double>(k * k % 6) - 2.5))};
  }
  return test::room({1, 1, 1}, walls);
}

/// Unit squares .01 apart that absorb a thousandth, one of them a lamp.
Scene close_plates() {
  constexpr double gap = 0.01, rho = 0.999;
  Scene scene;
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                    test::add_material(scene, rho, 0));
  test::add_polygon(scene, {{0, 1, gap}, {1, 1, gap}, {1, 0, gap}, {0, 0, gap}},
                    test::add_material(scene, rho, 1));
  return scene;
}

Scene room_named(const std::string& name) {
  const bool is_number = name.find_first_not_of("0123456789") == name.npos;
  if (is_number) return test::furnished_room(std::stoi(name));
  if (name == "bars_with_walls") return bars_with_walls();
  if (name == "uneven_furnace") return uneven_furnace();
  if (name == "close_plates") return close_plates();
  return read_data(name);
}

/// Furnished rooms take minutes to half a percent.
std::vector<double> tolerances_for(const std::string& name, const Scene& scene) {
  if (name == "dining_room") return {5e-2, 1.5e-2, 1e-2, 3e-3};
  if (scene.faces.size() > 80) return {5e-2, 1.5e-2};
  return {5e-2, 1e-2, 3e-3};
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
    names = {"cornell_box",
             "l_room",
             "table_and_chairs",
             "dining_room",
             "bars_with_walls",
             "uneven_furnace",
             "close_plates",
             "mural_room",
             "67",
             "187",
             "600",
             "1700",
             "5500"};
  for (const std::string& name : names) {
    const Scene scene = room_named(name);
    measure(name, scene, tolerances_for(name, scene));
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
