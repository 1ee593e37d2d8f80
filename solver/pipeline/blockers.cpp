#include "solver/pipeline/blockers.h"

#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

/// Of bodies that are looked at: it takes the square of it.
constexpr std::size_t most_faces_of_body = 1000;

std::vector<Vec3> outline(const Surface& surface) {
  std::vector<Vec3> corners;
  for (const Vec2& p : surface.rings.front()) corners.push_back(surface.frame.to_space(p));
  return corners;
}

bool is_convex_polygon(const Surface& surface, double margin) {
  if (surface.rings.size() > 1) return false;
  const Ring& ring = surface.rings.front();
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 ahead = (ring[(k + 1) % ring.size()] - ring[k]).normalized();
    for (const Vec2& p : ring)
      if (cross_2d(ahead, p - ring[k]) < -margin) return false;
  }
  return true;
}

/// Whether another surface has an edge with the same ends.
bool is_shared(const SoundScene& scene, const std::vector<int>& surfaces, int own, const Vec3& a,
               const Vec3& b) {
  return std::any_of(surfaces.begin(), surfaces.end(), [&](int s) {
    const std::vector<Vec3> corners = outline(scene.surfaces[at(s)]);
    const double margin = tolerance_of(scene.surfaces[at(own)], scene.surfaces[at(s)]).length;
    const auto same = [&](const Vec3& p, const Vec3& q) { return (p - q).norm() <= margin; };
    for (std::size_t k = 0; s != own && k < corners.size(); ++k)
      if (same(corners[k], b) && same(corners[(k + 1) % corners.size()], a)) return true;
    return false;
  });
}

/// Brings those to the front that reach farthest some way: inside of them, a surface has some
/// before and some behind it.
void put_outermost_first(const SoundScene& scene, std::vector<int>& ids) {
  std::vector<std::size_t> outermost;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        double farthest = -HUGE_VAL;
        std::size_t found = 0;
        for (std::size_t k = 0; k < ids.size(); ++k) {
          const Surface& surface = scene.surfaces[at(ids[k])];
          for (const Vec2& p : surface.rings.front())
            if (const double way = Vec3(x, y, z).dot(surface.frame.to_space(p)); way > farthest)
              farthest = way, found = k;
        }
        outermost.push_back(found);
      }
  std::sort(outermost.begin(), outermost.end());
  outermost.erase(std::unique(outermost.begin(), outermost.end()), outermost.end());
  for (std::size_t k = 0; k < outermost.size(); ++k) std::swap(ids[k], ids[outermost[k]]);
}

/// Whether there is some of `others` before a surface and some behind it. Most tell after a few
/// looks; only walls take all of them.
bool lies_between(const SoundScene& scene, const Surface& surface, std::span<const int> others) {
  bool has_before = false, has_behind = false;
  for (const int id : others) {
    const Surface& other = scene.surfaces[at(id)];
    const double margin = tolerance_of(surface, other).length;
    for (const Vec2& p : other.rings.front()) {
      const double height = surface.frame.height(other.frame.to_space(p));
      has_before = has_before || height > margin;
      has_behind = has_behind || height < -margin;
    }
    if (has_before && has_behind) return true;
  }
  return false;
}

}  // namespace

std::vector<int> blocking_surfaces(const SoundScene& scene) {
  std::vector<int> all(scene.surfaces.size());
  std::iota(all.begin(), all.end(), 0);
  return blocking_surfaces(scene, all, {});
}

std::vector<int> blocking_surfaces(const SoundScene& scene, std::span<const int> ids,
                                   std::span<const int> others) {
  std::vector<int> around(others.begin(), others.end());
  around.insert(around.end(), ids.begin(), ids.end());
  if (!around.empty()) put_outermost_first(scene, around);
  std::vector<int> blocking;
  for (const int id : ids) {
    const Surface& surface = scene.surfaces[at(id)];
    if (!surface.back && lies_between(scene, surface, around)) blocking.push_back(id);
  }
  return blocking;
}

bool is_one_convex_body(const SoundScene& scene, const std::vector<int>& surfaces) {
  const auto is_convex = [&](int r) {
    const Surface& surface = scene.surfaces[at(r)];
    return is_convex_polygon(surface, tolerance_of(surface).length);
  };
  if (!std::all_of(surfaces.begin(), surfaces.end(), is_convex)) return false;
  if (surfaces.size() <= 1) return true;
  if (surfaces.size() > most_faces_of_body) return false;
  for (const int r : surfaces) {
    const std::vector<Vec3> corners = outline(scene.surfaces[at(r)]);
    for (std::size_t k = 0; k < corners.size(); ++k)
      if (!is_shared(scene, surfaces, r, corners[k], corners[(k + 1) % corners.size()]))
        return false;
    for (const int s : surfaces) {
      const double margin = tolerance_of(scene.surfaces[at(r)], scene.surfaces[at(s)]).length;
      for (const Vec3& p : outline(scene.surfaces[at(s)]))
        if (scene.surfaces[at(r)].frame.height(p) > margin) return false;
    }
  }
  return true;
}

}  // namespace halfshade
