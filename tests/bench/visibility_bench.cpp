#include "meshing/rays/visibility.h"
#include "tests/support/soups.h"

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <memory>

// Rays and shafts per second among random small triangles in the unit cube; the argument is their
// number. "Coherent" segments come in bundles from neighbouring points to neighbouring points, as
// the samples between two elements do.

namespace halfshade {
namespace {

constexpr std::size_t segment_count = 1 << 16;

/// Sized so that about half of all segments are blocked for any number.
TriangleSoup scene(std::int64_t triangles) {
  test::Random random(1);
  return test::random_soup(static_cast<int>(triangles),
                           2 / std::sqrt(static_cast<double>(triangles)), random);
}

std::vector<Segment> segments(bool coherent) {
  test::Random random(2);
  std::vector<Segment> out;
  Segment bundle{Vec3::Zero(), Vec3::Zero()};
  for (std::size_t i = 0; i < segment_count; ++i) {
    if (!coherent || i % 64 == 0) bundle = {random.point(0, 1), random.point(0, 1)};
    const double spread = coherent ? 0.01 : 0;
    out.push_back({bundle.from + random.point(0, spread), bundle.to + random.point(0, spread)});
  }
  return out;
}

void count(benchmark::State& state, std::size_t items) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
}

void build_index(benchmark::State& state) {
  const TriangleSoup soup = scene(state.range(0));
  for (auto _ : state) {
    const VisibilityIndex index(soup);
    benchmark::DoNotOptimize(&index);
  }
  count(state, soup.triangles.size());
}

void rays_single(benchmark::State& state, bool coherent) {
  const VisibilityIndex index(scene(state.range(0)));
  const auto rays = segments(coherent);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(index.blocked(rays[i++ % segment_count]));
  count(state, 1);
}

/// Batches small enough to stay on the calling thread.
void rays_packets(benchmark::State& state, bool coherent) {
  constexpr std::size_t batch_size = 64;
  const VisibilityIndex index(scene(state.range(0)));
  const auto rays = segments(coherent);
  std::vector<std::uint8_t> result(batch_size);
  std::size_t i = 0;
  for (auto _ : state) {
    index.blocked(std::span(rays).subspan(i % segment_count, batch_size), result);
    i += batch_size;
  }
  count(state, batch_size);
}

void rays_batch(benchmark::State& state, bool coherent) {
  const VisibilityIndex index(scene(state.range(0)));
  const auto rays = segments(coherent);
  std::vector<std::uint8_t> result(segment_count);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  for (auto _ : state) index.blocked(rays, result);
  count(state, segment_count);
}

void first_hits(benchmark::State& state) {
  const VisibilityIndex index(scene(state.range(0)));
  const auto rays = segments(false);
  std::size_t i = 0;
  for (auto _ : state) {
    const Segment& s = rays[i++ % segment_count];
    benchmark::DoNotOptimize(index.first_hit(s.from, s.to - s.from));
  }
  count(state, 1);
}

/// Shafts between quadrilaterals as large as elements are.
void shafts(benchmark::State& state) {
  const VisibilityIndex index(scene(state.range(0)));
  test::Random random(3);
  const double size = 0.02 * static_cast<double>(state.range(1));
  std::vector<std::vector<Vec3>> polygons;
  for (int i = 0; i < 1024; ++i) {
    const Vec3 p = random.point(0, 1), u = random.point(-size, size), v = random.point(-size, size);
    polygons.push_back({p, p + u, p + u + v, p + v});
  }
  std::size_t i = 0, candidates = 0;
  for (auto _ : state) {
    candidates += index.candidates(polygons[i % 1024], polygons[(i + 1) % 1024]).size();
    ++i;
  }
  count(state, 1);
  state.counters["candidates"] = static_cast<double>(candidates) / static_cast<double>(i);
}

BENCHMARK(build_index)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(rays_single, scattered, false)->Arg(1000)->Arg(100000);
BENCHMARK_CAPTURE(rays_single, coherent, true)->Arg(1000)->Arg(100000);
BENCHMARK_CAPTURE(rays_packets, scattered, false)->Arg(1000)->Arg(100000);
BENCHMARK_CAPTURE(rays_packets, coherent, true)->Arg(1000)->Arg(100000);
BENCHMARK_CAPTURE(rays_batch, scattered, false)
    ->Args({100000, 1})
    ->Args({100000, 2})
    ->UseRealTime();
BENCHMARK_CAPTURE(rays_batch, coherent, true)->Args({100000, 1})->Args({100000, 2})->UseRealTime();
BENCHMARK(first_hits)->Arg(1000)->Arg(100000);
BENCHMARK(shafts)->ArgsProduct({{100, 10000, 100000}, {1, 10}})->ArgNames({"triangles", "size"});

}  // namespace
}  // namespace halfshade
