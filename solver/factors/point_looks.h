#pragma once

#include "solver/direct/direct_light.h"
#include "solver/factors/sight_scene.h"

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace halfshade {

/// Form factors from points to visible parts of surfaces. What a point sees of a surface that is
/// joined of several is found once and kept for all of them. One a thread.
class PointLooks {
 public:
  /// `scene` must outlive it.
  explicit PointLooks(const SightScene& scene);
  ~PointLooks();

  /// As DirectLightIndex::factor. What is kept changes no bit of it.
  PointFactor factor(const SurfacePoint& point, int surface);

  void forget();

 private:
  /// What a point sees of a joined surface.
  struct Look;
  struct Place {
    int joined;
    std::array<double, 3> position;
    bool operator==(const Place&) const = default;
  };
  struct PlaceHash {
    std::size_t operator()(const Place& place) const;
  };
  /// A corner of what is seen of a surface, and what the border that starts there lies on.
  struct Corner {
    Vec2 at;
    std::uint32_t border;
  };

  const Look& look(const SurfacePoint& point, int joined);
  void clip(const Look& look, const FlatPiece& piece);
  void cut_off(const FlatPiece& piece, std::size_t side, double nearness);

  const SightScene& scene_;
  std::unordered_map<Place, std::unique_ptr<Look>, PlaceHash> looks_;
  VisiblePart part_;
  std::vector<Corner> corners_, next_;  // of the ring that is cut
};

}  // namespace halfshade
