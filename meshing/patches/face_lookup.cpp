#include "meshing/patches/face_lookup.h"

#include <cmath>

namespace halfshade {
namespace {

bool contains(const Ring& ring, const Vec2& p) {
  bool odd = false;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x()) odd = !odd;
  }
  return odd;
}

double squared_distance(const Ring& ring, const Vec2& p) {
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 &a = ring[k], d = ring[(k + 1) % ring.size()] - a;
    const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + t * d - p).squaredNorm());
  }
  return least;
}

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
    if ((first < 0 || i < first) && contains(rings_[static_cast<std::size_t>(i)], point)) first = i;
  });
  if (first >= 0) return faces_[static_cast<std::size_t>(first)];
  std::size_t nearest = 0;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const double distance = squared_distance(rings_[i], point);
    if (distance >= least) continue;
    least = distance;
    nearest = i;
  }
  return faces_[nearest];
}

}  // namespace halfshade
