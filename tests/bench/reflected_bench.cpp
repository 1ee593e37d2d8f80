// What reflected light is made of, beside what the machine can do: rays over hemispheres against
// Embree's own first hits of the same rays; rows of exactly visible parts; and the product of a
// matrix of kept rays with what leaves, to compare with memory_read_bandwidth.

#include "meshing/repair/repair.h"
#include "solver/reflected/exact_sight.h"
#include "solver/reflected/irradiance_row.h"
#include "solver/reflected/ray_exchange.h"
#include "tests/support/room_families.h"

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

namespace halfshade {
namespace {

/// A furnished room as reflected light sees it, with even direct light, on elements of order 2.
struct Room {
  explicit Room(int polygons, double length)
      : scene(make_sound(test::furnished_room(polygons))),
        reflecting(make_reflecting_scene(scene)),
        light(first_light(
            scene, reflecting.roots, [](int, const Vec3&) { return Rgb(Rgb::Ones()); }, false)),
        mesh(make_reflected_mesh(reflecting.roots, length, 2, 100000)) {}

  SoundScene scene;
  ReflectingScene reflecting;
  FirstLight light;
  ReflectedMesh mesh;

  RayOrigin origin(std::size_t k) const {
    const int e = static_cast<int>(k * 7919 % at(mesh.count()));
    return ray_origin(reflecting, mesh, e, TrianglePlace::Constant(1. / 3));
  }
};

constexpr int strata = 16;

void count_rays(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * strata * strata);
}

/// With finding the element's place, cells of space and surfaces back to back.
void hemisphere_rays(benchmark::State& state) {
  const Room room(static_cast<int>(state.range(0)), 0.5);
  std::size_t k = 0;
  for (auto _ : state) {
    const RayHemisphere hemisphere{room.origin(k), strata, k};
    benchmark::DoNotOptimize(trace_hemispheres(room.reflecting, {&hemisphere, 1}).ends.data());
    ++k;
  }
  count_rays(state);
}
BENCHMARK(hemisphere_rays)->Arg(100)->Arg(1700)->Arg(5500);

/// Rays from the nodes of one element after another, seven by seven: all of an element's together,
/// or each hemisphere alone.
void rays_of_elements(benchmark::State& state) {
  const Room room(static_cast<int>(state.range(0)), 0.5);
  const bool together = state.range(1) == 1;
  std::size_t k = 0, rays = 0;
  for (auto _ : state) {
    const int e = static_cast<int>(k++ * 7919 % at(room.mesh.count()));
    const std::vector<RayHemisphere> all =
        halves_of_nodes(room.reflecting, room.mesh, e, 7, {0, 1});
    const std::size_t at_once = together ? all.size() : 1;
    for (std::size_t h = 0; h < all.size(); h += at_once)
      benchmark::DoNotOptimize(
          trace_hemispheres(room.reflecting, std::span(all).subspan(h, at_once)).ends.data());
    rays += all.size() * 49;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(rays));
}
BENCHMARK(rays_of_elements)->ArgsProduct({{100, 1700, 5500}, {0, 1}});

/// The same number of rays from the same points over the same triangles, their hits alone.
void hemisphere_hits(benchmark::State& state) {
  const Room room(static_cast<int>(state.range(0)), 0.5);
  std::vector<HalfLine> rays(at(strata * strata));
  std::vector<Hit> hits(rays.size());
  std::size_t k = 0;
  for (auto _ : state) {
    const RayOrigin from = room.origin(k);
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), from.normal);
    for (int i = 0; i < strata * strata; ++i) {
      const double square = (i % strata + random_number(k, at(2 * i))) / strata;
      const double angle = 2 * M_PI * (i / strata + random_number(k, at(2 * i + 1))) / strata;
      rays[at(i)] = {from.position,
                     turn * Vec3(std::sqrt(square) * std::cos(angle),
                                 std::sqrt(square) * std::sin(angle), std::sqrt(1 - square))};
    }
    room.reflecting.visibility.first_hits(rays, Sides::both, hits);
    benchmark::DoNotOptimize(hits.data());
    ++k;
  }
  count_rays(state);
}
BENCHMARK(hemisphere_hits)->Arg(100)->Arg(1700)->Arg(5500);

/// Rows a second, with the visible part of every surface and the walk of its forest.
void exact_rows(benchmark::State& state) {
  const Room room(static_cast<int>(state.range(0)), 0.5);
  const ExactSight sight(room.scene, room.reflecting);
  const RowMaker maker(sight, room.mesh, {3e-5, 3e-3, 5});
  std::size_t k = 0, moments = 0;
  for (auto _ : state) {
    const int e = static_cast<int>(k++ * 7919 % at(room.mesh.count()));
    const auto targets =
        sight.may_see(room.mesh.forest.corners(room.mesh.triangle[at(e)]), room.mesh.root(e));
    const IrradianceRow row = maker.row({room.mesh.position(e, TrianglePlace::Constant(1. / 3)),
                                         room.reflecting.roots.normal[at(room.mesh.root(e))]},
                                        targets);
    moments += row.moments.size();
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["moments"] = static_cast<double>(moments) / static_cast<double>(k);
}
BENCHMARK(exact_rows)->Arg(30)->Arg(100)->Arg(300)->Unit(benchmark::kMillisecond);

/// Bytes read per second by one application: for each end 12, and 144 of the polynomial it meets.
void kept_rays_times_light(benchmark::State& state) {
  const Room room(static_cast<int>(state.range(0)), 0.2);
  RayExchange exchange(room.reflecting, room.light, 7);
  if (!exchange.update(room.mesh, {})) state.SkipWithError("stopped");
  ElementField leaving = zero_field(room.mesh);
  leaving.coefficients.setOnes();
  for (auto _ : state)
    benchmark::DoNotOptimize(exchange.apply(room.mesh, leaving).coefficients.data());
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>((12 + 144) * exchange.rays()));
}
BENCHMARK(kept_rays_times_light)->Arg(100)->Arg(5500)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halfshade
