#include "solver/factors/shadow_union.h"

namespace halfshade {

void ShadowUnion::add_edges(ShadowCut::Corners polygon, std::span<const FlatShadow> shadows,
                            double nearness, FlatEdges& edges) {
  shadows_ = shadows;
  nearness_ = nearness;
  edges_ = &edges;
  if (common_.size() < shadows.size()) common_.resize(shadows.size());
  add(polygon, 0, 0);
}

/// `polygon` is what lies in `depth` of the shadows before `first`.
void ShadowUnion::add(ShadowCut::Corners polygon, std::size_t depth, std::size_t first) {
  FlatBox box;
  for (std::size_t k = 0; k < polygon.count; ++k) box.add(polygon.x[k], polygon.y[k]);
  for (std::size_t s = first; s < shadows_.size(); ++s) {
    if (!shadows_[s].box.meets(box)) continue;
    const ShadowCut::Corners part = cut_.common(polygon, shadows_[s].sides, nearness_);
    if (part.count < 3) continue;
    if (depth % 2 == 0)
      edges_->add(part.x, part.y, part.count);
    else
      edges_->subtract(part.x, part.y, part.count);
    if (s + 1 == shadows_.size()) continue;
    auto& [x, y] = common_[depth];
    x.assign(part.x, part.x + part.count);
    y.assign(part.y, part.y + part.count);
    add({x.data(), y.data(), x.size()}, depth + 1, s + 1);
  }
}

}  // namespace halfshade
