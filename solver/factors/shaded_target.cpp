#include "solver/factors/shaded_target.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr std::size_t most_cut_parts = 1024;
/// Of each shadow on average: with fewer, parts are few, too.
constexpr std::size_t many_sides = 12;
/// What is seen of a target that shadows cover but for this share, may be rounding.
constexpr double about_dark = 1e-12;

}  // namespace

ShadedTarget::ShadedTarget(PlaneShadows& shadows, TargetMemory& memory, const Vec3& normal,
                           double nearness)
    : shadows_(&shadows),
      memory_(&memory),
      normal_(normal),
      nearness_(nearness),
      first_corner_(memory.x.size()),
      first_part_(memory.ends.size()),
      last_part_(first_part_),
      first_thing_(memory.things.size()),
      last_thing_(first_thing_) {}

void ShadedTarget::add_part(std::span<const FlatParts::Corner> corners) {
  for (const FlatParts::Corner& corner : corners) {
    memory_->x.push_back(corner.at.x());
    memory_->y.push_back(corner.at.y());
    box_.add(corner.at.x(), corner.at.y());
  }
  memory_->ends.push_back(memory_->x.size());
  last_part_ = memory_->ends.size();
}

void ShadedTarget::add(const TargetMemory::Thing& thing) {
  memory_->things.push_back(thing);
  last_thing_ = memory_->things.size();
}

void ShadedTarget::add_body(int body) { add({shadows_->number_of_body(body), true, false}); }

void ShadedTarget::add_polygon(const Blocker& polygon) {
  const int number = shadows_->number_of_polygon(polygon);
  // It hides only what lies beyond its plane.
  const ShadowSide& plane = shadows_->plane_of(number);
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (std::size_t k = first_corner_; k < memory_->x.size(); ++k) {
    const double height = plane.ax * memory_->x[k] + plane.ay * memory_->y[k] + plane.b;
    least = std::min(least, height);
    most = std::max(most, height);
  }
  const double near = plane.near(nearness_);
  add({number, least<-near, most> near});
}

template <class Use>
void ShadedTarget::for_each_part(Use use) const {
  std::size_t first = first_corner_;
  for (std::size_t k = first_part_; k < last_part_; ++k) {
    const std::size_t end = memory_->ends[k];
    use(ShadowCut::Corners{memory_->x.data() + first, memory_->y.data() + first, end - first});
    first = end;
  }
}

/// True if it hides all.
bool ShadedTarget::add_hit(int thing) const {
  const std::size_t before = memory_->crossing.size();
  if (!add_crossing(shadows_->sides(thing), box_, nearness_, memory_->crossing)) return false;
  memory_->hits.push_back({before, memory_->crossing.size(), shadows_->box(thing)});
  return memory_->crossing.size() == before;
}

/// Of things that show the point one side, until one hides all.
void ShadedTarget::add_hits(int side, bool& has_others, bool& hides_all) const {
  for (const auto& [thing, from_front, from_back] : things()) {
    const int seen = shadows_->side(thing);
    if (!(seen > 0 ? from_front : from_back) || seen == 0) continue;
    has_others = has_others || seen != side;
    if (seen == side && shadows_->box(thing).meets(box_) && (hides_all = add_hit(thing))) return;
  }
}

/// Finds hits that lie apart from all others: with many it is not worth it. If one of them hides
/// something of a convex target, the others do not hide all the rest.
void ShadedTarget::part_hits() const {
  constexpr std::size_t many = 16;
  std::vector<TargetMemory::Hit>& hits = memory_->hits;
  if (hits.size() > many || last_part_ - first_part_ > 1) return;
  for (TargetMemory::Hit& hit : hits) hit.is_apart = true;
  for (std::size_t k = 0; k < hits.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)
      if (hits[k].box.meets(hits[l].box)) hits[k].is_apart = hits[l].is_apart = false;
}

void ShadedTarget::take_all() const {
  memory_->cut.clear();
  for_each_part([&](const ShadowCut::Corners& part) { memory_->cut.add(part); });
}

/// What lies in those hits that are not apart from all others.
void ShadedTarget::add_union() const {
  std::vector<FlatShadow>& shadows = memory_->shadows;
  shadows.clear();
  for (const TargetMemory::Hit& hit : memory_->hits)
    if (!hit.is_apart) shadows.push_back({hit.sides(memory_->crossing), hit.box});
  for_each_part([&](const ShadowCut::Corners& part) {
    memory_->together.add_edges(part, shadows, nearness_, memory_->edges);
  });
}

double ShadedTarget::sum_of_all() const {
  memory_->edges.clear();
  for_each_part(
      [&](const ShadowCut::Corners& part) { memory_->edges.add(part.x, part.y, part.count); });
  return sum_of_edges();
}

double ShadedTarget::sum_of_edges() const {
  return std::max(0., memory_->edges.form_factor(shadows_->point(), normal_));
}

bool ShadedTarget::hidden_factor(HiddenFactor& factor) const {
  factor = {};
  if (!(shadows_->point().z() > 0) || first_part_ == last_part_) return true;
  std::vector<TargetMemory::Hit>& hits = memory_->hits;
  std::vector<ShadowSide>& crossing = memory_->crossing;
  ShadowCut& cut = memory_->cut;
  FlatEdges& edges = memory_->edges;
  crossing.clear();
  hits.clear();
  const auto add_edges = [&](const ShadowCut::Corners& part) {
    if (part.count > 2) edges.add(part.x, part.y, part.count);
  };
  // Fronts first: what backs of closed things hide is hidden then.
  bool has_backs = false, hides_all = false;
  add_hits(1, has_backs, hides_all);
  if (has_backs && !hides_all) add_hits(-1, has_backs, hides_all);
  edges.clear();
  if (hides_all) {
    for_each_part(add_edges);
    factor.hidden = sum_of_edges();
    return true;
  }
  factor.is_dark = false;
  if (hits.empty()) return true;
  part_hits();
  // What lies apart from all others is cut off the whole.
  std::size_t together = 0, sides = 0;
  for (const TargetMemory::Hit& hit : hits) {
    together += hit.is_apart ? 0 : 1;
    sides += hit.is_apart ? 0 : hit.end - hit.first;
    if (hit.is_apart)
      for_each_part([&](const ShadowCut::Corners& part) {
        add_edges(cut.common(part, hit.sides(crossing), nearness_));
      });
  }
  if (together == 0) {
    factor.hidden = sum_of_edges();
    return true;
  }
  if (together <= ShadowUnion::most_shadows && sides > many_sides * together) {
    add_union();
    factor.hidden = sum_of_edges();
    factor.is_dark = factor.hidden >= (1 - about_dark) * sum_of_all();
    return true;
  }
  take_all();
  for (std::size_t k = 0; k < hits.size() && cut.count() > 0; ++k) {
    if (hits[k].is_apart) continue;
    cut.cut_off(hits[k].sides(crossing), hits[k].box, nearness_, --together > 0, add_edges);
    if (cut.count() > most_cut_parts) return false;
  }
  factor.is_dark = cut.count() == 0;
  factor.hidden = sum_of_edges();
  return true;
}

}  // namespace halfshade
