#include "solver/factors/exchange_work.h"

#include "meshing/geometry/mix_bits.h"

#include <cstdint>

namespace halfshade {
namespace {

/// So many pairs of surfaces are looked at to tell how many of all something comes between.
constexpr int pairs_to_try = 4000;
constexpr double looks_of_pair = 64;
/// Of a look, and what each polygon that may come between adds to it. Of convex bodies few do, each
/// of which all edges are looked at.
constexpr double look_seconds = 1e-6, seconds_for_polygon = 3e-8, seconds_for_edge = 5e-9;
/// To find out what two surfaces see of each other, whatever it is.
constexpr double pair_seconds = 1e-7;
constexpr double ray_seconds = 1e-6;

/// Of pairs that are chosen at random, the same ones each time.
double share_of_partial_pairs(const FactorScene& scene, const SightScene& sight) {
  std::uint64_t state = 0;
  const auto any = [&] {
    return static_cast<int>(mix_bits(state += splitmix_step) % sight.surfaces.size());
  };
  int partial = 0;
  for (int k = 0; k < pairs_to_try; ++k) {
    const int a = any(), b = any();
    const bool has_row = scene.row[at(a)] >= 0 || scene.row[at(b)] >= 0;
    if (a != b && has_row && sight_between(sight, a, b) == Sight::partial) ++partial;
  }
  return static_cast<double>(partial) / pairs_to_try;
}

}  // namespace

double exact_seconds(const FactorScene& scene, const SightScene& sight) {
  const auto surfaces = static_cast<double>(sight.surfaces.size());
  const double pairs = surfaces * surfaces / 2;
  double look = look_seconds;
  for (const Blocker& blocker : sight.blockers)
    if (blocker.body < 0) look += seconds_for_polygon;
  const auto bodies = static_cast<double>(sight.bodies.size());
  for (const ConvexBody& body : sight.bodies)
    look += static_cast<double>(body.edges.size()) / bodies * seconds_for_edge;
  const double looks = share_of_partial_pairs(scene, sight) * looks_of_pair;
  return pairs * (pair_seconds + looks * look);
}

std::size_t rays_in(double seconds) { return static_cast<std::size_t>(seconds / ray_seconds); }

}  // namespace halfshade
