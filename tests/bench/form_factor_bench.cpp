#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "solver/exchange/exchange.h"
#include "solver/exchange/form_factor.h"
#include "tests/support/scenes.h"

#include <benchmark/benchmark.h>

#include <array>
#include <vector>

namespace halfshade {
namespace {

using Triangle = std::array<Vec3, 3>;

const Triangle floor_triangle = {Vec3(0, 0, 0), Vec3(0.9, 0, 0), Vec3(0.2, 1, 0)};

/// Closed form at a point: the inner loop of everything.
void point_to_triangle(benchmark::State& state) {
  const Triangle above = {Vec3(0, 0, 1), Vec3(0.2, 1, 1), Vec3(0.9, 0, 1)};
  Vec3 x(0.3, 0.2, 0);
  for (auto _ : state) {
    x.x() += 1e-9;
    benchmark::DoNotOptimize(lambert_sum(x, Vec3::UnitZ(), above));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(point_to_triangle);

/// Form factors of triangles at the distance range(0) times their size, to 1e-4.
void distant_pair(benchmark::State& state) {
  const double h = static_cast<double>(state.range(0));
  const Triangle above = {Vec3(0, 0, h), Vec3(0.2, 1, h), Vec3(0.9, 0, h)};
  for (auto _ : state)
    benchmark::DoNotOptimize(mutual_area(floor_triangle, above, {.tolerance = 1e-4}).value);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(distant_pair)->Arg(2)->Arg(10)->Arg(50);

/// Triangles that share an edge, to 10^−range(0).
void touching_pair(benchmark::State& state) {
  const Triangle wall = {Vec3(0.9, 0, 0), Vec3(0, 0, 0), Vec3(0.4, 0, 0.8)};
  const double tolerance = std::pow(10., -static_cast<double>(state.range(0)));
  int points = 0;
  for (auto _ : state) {
    const MutualArea area = mutual_area(floor_triangle, wall, {.tolerance = tolerance});
    points = area.points;
    benchmark::DoNotOptimize(area.value);
  }
  state.counters["points"] = points;
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(touching_pair)->Arg(4)->Arg(8)->Arg(12);

struct MeshedRoom {
  SoundScene scene = make_sound(test::l_room(true));
  ElementTable elements;
  VisibilityIndex visibility{occluders(scene)};

  explicit MeshedRoom(int count) {
    PlanarMeshOptions options;
    options.max_length = length_for_count(scene, count);
    elements = PatchMesh(scene, options).elements();
  }
};

/// Form factors per second with visibility, all threads.
void exchange_of_a_room(benchmark::State& state) {
  const MeshedRoom room(static_cast<int>(state.range(0)));
  std::size_t factors = 0, rays = 0;
  for (auto _ : state) {
    const Exchange exchange = compute_exchange(room.scene, room.elements, room.visibility);
    factors += exchange.report.factors / 2;
    rays += exchange.report.rays;
  }
  state.counters["factors/s"] =
      benchmark::Counter(static_cast<double>(factors), benchmark::Counter::kIsRate);
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
}
BENCHMARK(exchange_of_a_room)->Arg(1000)->Arg(4000)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halfshade
