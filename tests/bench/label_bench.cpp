#include "meshing/core/light_source.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/room_families.h"

#include <benchmark/benchmark.h>

// Labels of a furnished room's complete mesh, by cells between curves and by elements.

namespace halfshade {
namespace {

using LabelFunction = decltype(&label_cells);

void label_room(benchmark::State& state, LabelFunction label) {
  const SoundScene scene = make_sound(test::furnished_room(static_cast<int>(state.range(0))));
  const OpaqueScene opaque(scene);
  const std::vector<LightSource> sources = light_sources(scene);
  const Discontinuities found = find_discontinuities(scene, opaque, sources);
  const ElementTable elements = mesh_discontinuities(scene, found, {}).patches.elements();
  for (auto _ : state)
    benchmark::DoNotOptimize(label(scene, opaque, elements, sources, Progress()));
  state.counters["elements"] = elements.count();
}

BENCHMARK_CAPTURE(label_room, by_cells, &label_cells)
    ->Arg(100)
    ->Arg(300)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(label_room, by_elements, &label_elements)
    ->Arg(100)
    ->Arg(300)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace halfshade
