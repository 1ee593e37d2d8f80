#include "meshing/patches/face_lookup.h"

#include "meshing/core/planar.h"

#include <cmath>

namespace halfshade {
namespace {

std::vector<Bounds> boxes(const std::vector<Ring>& rings) {
  std::vector<Bounds> result;
  for (const Ring& ring : rings) {
    Bounds box;
    for (const Vec2& p : ring) box.include(flat_bounds(p, p));
    result.push_back(box);
  }
  return result;
}

}  // namespace

FaceLookup::FaceLookup(const Surface& surface)
    : faces_(surface.faces), rings_(surface.face_rings), tree_(make_flat_tree(boxes(rings_), 1)) {}

int FaceLookup::face_at(const Vec2& point) const {
  if (faces_.size() == 1) return faces_[0];
  int first = -1;
  visit_overlaps(tree_, flat_bounds(point, point), [&](int i) {
    if ((first < 0 || i < first) && is_inside(std::span(&rings_[at(i)], 1), point)) first = i;
  });
  if (first >= 0) return faces_[at(first)];
  std::size_t nearest = 0;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const double distance = distance_to_rings(std::span(&rings_[i], 1), point);
    if (distance >= least) continue;
    least = distance;
    nearest = i;
  }
  return faces_[nearest];
}

}  // namespace halfshade
