#include "io/read/read_scene.h"
#include "solver/pipeline/solve.h"
#include "tests/support/places.h"

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

// What it saves to leave out what a scene does not need: each stage left out and forced, on a scene
// that does not need it. The answers are the same, which tests see to.

namespace halfshade {
namespace {

void solve_scene(benchmark::State& state, const std::string& name,
                 const std::function<void(Scene&)>& prepare, const SolveOptions& options) {
  Scene scene = read_scene(std::string(test::data_folder) + "/" + name + ".obj").scene;
  prepare(scene);
  std::size_t elements = 0;
  for (auto _ : state) elements = solve(scene, options).elements.corners.size();
  state.counters["elements"] = static_cast<double>(elements);
}

void add_pair(
    const std::string& stage, const std::string& scene, const ForcedStages& force,
    SolveOptions options = {}, const std::function<void(Scene&)>& prepare = [](Scene&) {}) {
  for (const bool forced : {false, true}) {
    options.force = forced ? force : ForcedStages{};
    benchmark::RegisterBenchmark(
        (stage + (forced ? "/forced" : "/left out")).c_str(),
        [=](benchmark::State& state) { solve_scene(state, scene, prepare, options); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

void make_grey(Scene& scene) {
  for (Material& material : scene.materials) {
    material.rho = Rgb::Constant(material.rho.mean());
    material.exitance = Rgb::Constant(material.exitance.mean());
  }
}

void make_black(Scene& scene) {
  for (Material& material : scene.materials) material.rho.setZero();
}

/// Where the default would not look for curves.
SolveOptions along_curves() {
  SolveOptions options;
  options.tolerance = 1e-4;
  return options;
}

SolveOptions by_matrix() {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 1000;
  return options;
}

[[maybe_unused]] const bool registered = [] {
  add_pair("discontinuities", "furnace_cube", {.discontinuities = true});
  add_pair("exact direct light", "furnace_cube", {.exact_direct_light = true});
  add_pair("curves at three edges", "s1", {.eee = true}, along_curves());
  add_pair("reflected light", "cornell_box", {.factors = true}, {}, make_black);
  add_pair("second and third channel", "l_room", {.channels = true}, {}, make_grey);
  add_pair("form factors of a matrix", "cornell_box", {.factors = true}, by_matrix(), make_black);
  return true;
}();

}  // namespace
}  // namespace halfshade
