#pragma once

#include "solver/factors/flat_parts.h"
#include "solver/factors/flat_sum.h"
#include "solver/factors/plane_shadows.h"
#include "solver/factors/shadow_union.h"

#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// What is hidden of a surface from a point.
struct HiddenFactor {
  double unobstructed = 0;      ///< form factor to the whole surface above the horizon
  double hidden = 0;            ///< the part of it that is hidden: `unobstructed` if all is
  bool is_dark = true;          ///< nothing is seen
  std::uint64_t signature = 0;  ///< of the edges that bound what is hidden

  double visible() const { return is_dark ? 0 : unobstructed - hidden; }
};

/// Memory of targets that are looked at in turn, side by side.
struct TargetMemory {
  /// A shadow that may reach a target.
  struct Hit {
    std::size_t first, end;  ///< of its sides in `crossing`
    FlatBox box;             ///< that it lies in
    bool is_apart = false;   ///< from all others

    std::span<const ShadowSide> sides(const std::vector<ShadowSide>& crossing) const {
      return {crossing.data() + first, end - first};
    }
  };
  std::vector<double> x, y;       ///< of parts
  std::vector<std::size_t> ends;  ///< of parts
  struct Thing {
    int number;                  ///< in PlaneShadows
    bool from_front, from_back;  ///< hides something from points that look at that side
  };
  std::vector<Thing> things;
  // Of one look:
  ShadowCut cut;
  std::vector<ShadowSide> crossing;
  std::vector<Hit> hits;
  FlatEdges edges;
  ShadowUnion together;
  std::vector<FlatShadow> shadows;
};

/// A surface, or what lies of it before another one, and what comes between: as FewBlockers, from
/// points whose shadows serve all surfaces of a plane, and only for what is hidden.
class ShadedTarget {
 public:
  /// `shadows`, of the target's plane, and `memory` must outlive it; `normal` of the surface that
  /// looks is in the frame of the plane; what is nearer to a line than `nearness` lies on it. Parts
  /// of one target are added first, then things, and then the next one is made.
  ShadedTarget(PlaneShadows& shadows, TargetMemory& memory, const Vec3& normal, double nearness);

  void add_part(std::span<const FlatParts::Corner> corners);
  void add_body(int body);
  void add_polygon(const Blocker& polygon);

  /// `hidden` and `is_dark` from where the shadows are. False if they cut it into too many parts.
  bool hidden_factor(HiddenFactor& factor) const;

 private:
  void add(const TargetMemory::Thing& thing);
  void add_hits(int side, bool& has_others, bool& hides_all) const;
  template <class Use>
  void for_each_part(Use use) const;
  bool add_hit(int thing) const;
  void part_hits() const;
  void take_all() const;
  void add_union() const;
  double sum_of_all() const;
  double sum_of_edges() const;
  std::span<const TargetMemory::Thing> things() const {
    return {memory_->things.data() + first_thing_, last_thing_ - first_thing_};
  }

  PlaneShadows* shadows_;
  TargetMemory* memory_;
  Vec3 normal_;
  double nearness_;
  FlatBox box_;
  std::size_t first_corner_, first_part_, last_part_, first_thing_, last_thing_;
};

}  // namespace halfshade
