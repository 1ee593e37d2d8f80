#include "solver/factors/lattice_sight.h"

#include "solver/factors/few_blockers.h"
#include "solver/factors/pair_on_lattices.h"

#include <algorithm>
#include <memory>

namespace halfshade {
namespace {

/// What of a surface lies before the plane of another; `is_all` if nothing but rounding lies
/// behind.
struct PartBefore {
  std::vector<Quad> quads;
  bool is_all = true;
};

PartBefore part_before(const SightSurface& surface, const SightSurface& other) {
  const double margin = tolerance_of(joint_scale(surface.scale, other.scale)).length;
  const PlaneFrame& plane = other.frame;
  PartBefore part;
  for (const Polygon3& piece : surface.pieces) {
    const bool is_before = std::all_of(piece.begin(), piece.end(),
                                       [&](const Vec3& p) { return plane.height(p) >= -margin; });
    add_quads(is_before ? piece : clip_to_front(piece, plane.origin, plane.normal), part.quads);
    part.is_all = part.is_all && is_before;
  }
  return part;
}

/// A surface as another one looks at it.
LatticeTarget target_of(const SightScene& scene, int a, const LatticePair& pair,
                        std::span<const Quad> quads, SharedShadows& shadows, TargetMemory& memory,
                        const std::stop_token& stop) {
  const FewBlockers few(scene, a, pair.other, {pair.blockers.begin(), pair.blockers.end()});
  LatticeTarget target;
  const ShadedTarget shaded = few.shaded_target(shadows, memory);
  target.hidden_factor = [shaded](HiddenFactor& factor) { return shaded.hidden_factor(factor); };
  target.unhidden = [&scene, a, other = pair.other, &stop](const SightTolerance& tolerance) {
    return clear_sight(scene, a, other, tolerance, stop);
  };
  if (few.is_applicable()) target.points_across = few.points_across(quads);
  return target;
}

}  // namespace

std::vector<std::optional<MutualSight>> lattice_sight(const SightScene& scene, int a,
                                                      std::span<const LatticePair> pairs,
                                                      std::size_t most_places,
                                                      const std::stop_token& stop) {
  if (pairs.empty()) return {};
  const SightSurface& own = scene.surfaces[at(a)];
  std::vector<Quad> all;
  for (const Polygon3& piece : own.pieces) add_quads(piece, all);
  // Pairs that look from all of the surface share their points.
  std::vector<std::unique_ptr<PairOnLattices>> looks;
  std::vector<PairOnLattices*> from_all;
  SharedShadows shadows(scene);
  TargetMemory memory;
  for (const LatticePair& pair : pairs) {
    looks.push_back(nullptr);
    if (stop.stop_requested() || !in_all_cells_of(scene, a, pair.other)) continue;
    const PartBefore part = part_before(own, scene.surfaces[at(pair.other)]);
    looks.back() = std::make_unique<PairOnLattices>(
        target_of(scene, a, pair, part.quads, shadows, memory, stop), part.quads.size(),
        LatticeLimits{pair.tolerance, pair.to_the_end, most_places});
    PairOnLattices* look = looks.back().get();
    if (part.is_all)
      from_all.push_back(look);
    else
      look_at({look}, part.quads, shadows, stop);
  }
  look_at(from_all, all, shadows, stop);
  if (stop.stop_requested()) return std::vector<std::optional<MutualSight>>(pairs.size());
  std::vector<std::optional<MutualSight>> result;
  for (const auto& look : looks) {
    result.emplace_back();
    if (look && look->tells()) result.back() = look->sight();
  }
  return result;
}

}  // namespace halfshade
