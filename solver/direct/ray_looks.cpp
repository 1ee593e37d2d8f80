#include "solver/direct/ray_looks.h"

#include "meshing/backprojection/edge_sum.h"

#include <optional>

namespace halfshade {
namespace {

std::optional<RayLook> look_at(const RayEmitter& emitter, const SurfacePoint& point) {
  if (is_clearly_away(emitter.target, point)) return std::nullopt;
  const double rough = far_factor(point, emitter);
  const double factor = rough < 0 ? exact_factor(point, emitter) : rough;
  if (!(factor > 0)) return std::nullopt;
  return RayLook{&emitter, -1, factor, factor * emitter.target.strength, rough >= 0};
}

}  // namespace

double exact_factor(const SurfacePoint& point, const RayEmitter& emitter) {
  return unobstructed_factor(point.position, point.normal, emitter.target.rings);
}

void collect_looks(const EmitterTree& tree, const SurfacePoint& point, double weak,
                   std::vector<RayLook>& looks) {
  looks.clear();
  visit_emitters(
      tree, point, weak,
      [&](const RayEmitter& emitter) {
        if (const auto look = look_at(emitter, point)) looks.push_back(*look);
      },
      [&](int node, double most) {
        looks.push_back({nullptr, node, 0, most});
      });
}

const RayEmitter* strongest_emitter(const EmitterTree& tree, const SurfacePoint& point) {
  const RayEmitter* strongest = nullptr;
  double most = 0;
  walk_tree(
      tree.tree, [&](int node) { return !(most_light(tree, node, point) > most); },
      [&](int item) {
        const auto look = look_at(tree.emitters[at(item)], point);
        if (!look || look->strength <= most) return;
        most = look->strength;
        strongest = look->emitter;
      });
  return strongest;
}

}  // namespace halfshade
