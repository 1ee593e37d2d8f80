#include "solver/factors/sight_scene.h"

#include "meshing/core/planar.h"
#include "meshing/triangulation/ring_triangles.h"

#include <algorithm>
#include <numeric>

namespace halfshade {
namespace {

bool is_convex(const Surface& surface) {
  if (surface.rings.size() > 1) return false;
  const Ring& ring = surface.rings.front();
  const double margin = tolerance_of(surface).length;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 along = ring[(k + 1) % ring.size()] - ring[k];
    const double length = along.norm();
    for (const Vec2& p : ring)
      if (cross_2d(along, p - ring[k]) < -margin * length) return false;
  }
  return true;
}

std::vector<Polygon3> convex_pieces(const Surface& surface, const Polygon3& outline) {
  if (is_convex(surface)) return {outline};
  Polygon3 corners;
  for (const Ring& ring : surface.rings)
    for (const Vec2& p : ring) corners.push_back(surface.frame.to_space(p));
  std::vector<Polygon3> pieces;
  for (const auto& [a, b, c] : ring_triangles(surface.rings))
    pieces.push_back({corners[at(a)], corners[at(b)], corners[at(c)]});
  return pieces;
}

SightSurface sight_surface(const Surface& surface) {
  SightSurface result;
  for (const Vec2& p : surface.rings.front()) result.outline.push_back(surface.frame.to_space(p));
  result.pieces = convex_pieces(surface, result.outline);
  result.frame = surface.frame;
  result.scale = surface.scale;
  result.area = area(surface);
  result.plane = surface.plane;
  return result;
}

FlatPiece flat_piece(const Polygon3& polygon, const PlaneFrame& frame) {
  FlatPiece piece;
  for (const Vec3& p : polygon) piece.corners.push_back(frame.to_plane(p));
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 side = piece.corners[(k + 1) % polygon.size()] - piece.corners[k];
    piece.size = std::max(piece.size, side.norm());
    piece.sides.push_back(side.normalized());
  }
  return piece;
}

/// What looks at the whole that a surface is a part of need.
void add_place_in_whole(const Surface& surface, const Surface& whole, SightSurface& result) {
  for (const Ring& ring : surface.rings) {
    result.rings.emplace_back();
    for (const Vec2& p : ring) result.rings.back().push_back(surface.frame.to_space(p));
  }
  for (const Polygon3& piece : result.pieces)
    result.flat_pieces.push_back(flat_piece(piece, surface.frame));
  for (const Vec2& p : whole.rings.front())
    result.magnitude_in_plane = std::max(result.magnitude_in_plane, p.cwiseAbs().maxCoeff());
}

VisibilityIndex index_of(const SoundScene& joined) {
  TriangleSoup soup = occluders(joined);
  std::iota(soup.owner.begin(), soup.owner.end(), 0);
  return VisibilityIndex(std::move(soup));
}

bool reaches_in_front(const Polygon3& outline, const PlaneFrame& frame, double margin) {
  return std::any_of(outline.begin(), outline.end(),
                     [&](const Vec3& p) { return frame.height(p) > margin; });
}

/// Whether each has a part before the plane of the other.
bool face_each_other(const SightSurface& a, const SightSurface& b) {
  const double margin = tolerance_of(joint_scale(a.scale, b.scale)).length;
  return a.plane != b.plane && reaches_in_front(a.outline, b.frame, margin) &&
         reaches_in_front(b.outline, a.frame, margin);
}

bool share_a_cell(const SightSurface& a, const SightSurface& b) {
  return std::find_first_of(a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end()) !=
         a.cells.end();
}

/// More pairs of pieces than this are looked at as two outlines, which may meet more.
constexpr std::size_t most_pairs = 64;

/// What of some polygons lies before a plane.
std::vector<Polygon3> facing(std::span<const Polygon3> polygons, const PlaneFrame& plane) {
  std::vector<Polygon3> result;
  for (const Polygon3& polygon : polygons)
    if (Polygon3 part = clip_to_front(polygon, plane.origin, plane.normal); !part.empty())
      result.push_back(std::move(part));
  return result;
}

}  // namespace

SightScene make_sight_scene(const SoundScene& scene, const Progress& progress) {
  JoinedScene joined = join_coplanar(scene);
  VisibilityIndex between = index_of(joined.sound);
  DirectLightIndex light(joined.sound);
  SightScene result{{},
                    make_reflecting_scene(scene, progress),
                    std::move(joined),
                    std::move(between),
                    std::move(light)};
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    SightSurface surface = sight_surface(scene.surfaces[s]);
    surface.joined = result.joined.of[s];
    if (result.joined.parts[at(surface.joined)].size() > 1)
      add_place_in_whole(scene.surfaces[s], result.joined.sound.surfaces[at(surface.joined)],
                         surface);
    result.surfaces.push_back(std::move(surface));
  }
  const ElementTable& roots = result.reflecting.roots;
  for (int root = 0; root < roots.count(); ++root) {
    SightSurface& surface = result.surfaces[at(roots.surface[at(root)])];
    surface.roots.push_back(root);
    result.reflecting.two_sided[at(root)] = true;  // unused backs are surfaces, too
    const int cell = result.reflecting.cells.before(root);
    if (std::find(surface.cells.begin(), surface.cells.end(), cell) == surface.cells.end())
      surface.cells.push_back(cell);
  }
  return result;
}

Sight sight_between(const SightScene& scene, int a, int b) {
  const SightSurface &p = scene.surfaces[at(a)], &q = scene.surfaces[at(b)];
  if (!face_each_other(p, q) || !share_a_cell(p, q)) return Sight::none;
  const bool is_simple = p.pieces.size() * q.pieces.size() <= most_pairs;
  const auto parts = [&](const SightSurface& surface, const SightSurface& other) {
    return facing(is_simple ? std::span(surface.pieces) : std::span(&surface.outline, 1),
                  other.frame);
  };
  const std::vector<Polygon3> others = parts(q, p);
  for (const Polygon3& part : parts(p, q))
    for (const Polygon3& other : others)
      if (!triangles_between(scene, part, a, other, b).empty()) return Sight::partial;
  return Sight::clear;
}

std::vector<int> triangles_between(const SightScene& scene, std::span<const Vec3> part, int a,
                                   std::span<const Vec3> other, int b) {
  const VisibilityIndex& visibility = scene.between;
  const int p = scene.surfaces[at(a)].plane, q = scene.surfaces[at(b)].plane;
  std::vector<int> triangles = visibility.candidates(part, other);
  // Light that leaves a plane does not cross it again.
  std::erase_if(triangles, [&](int t) {
    const int plane = visibility.soup().plane[at(t)];
    return plane == p || plane == q;
  });
  return triangles;
}

FacingTriangles facing_triangles(const SightScene& scene, int a, int b) {
  const SightSurface &p = scene.surfaces[at(a)], &q = scene.surfaces[at(b)];
  FacingTriangles result;
  for (const int root : p.roots) {
    const int cell = scene.reflecting.cells.before(root);
    if (std::find(q.cells.begin(), q.cells.end(), cell) == q.cells.end()) {
      result.is_all = false;
      continue;
    }
    const Polygon3 facing =
        clip_to_front(scene.reflecting.roots.triangle(root), q.frame.origin, q.frame.normal);
    for (std::size_t k = 1; k + 1 < facing.size(); ++k)
      result.triangles.push_back({facing[0], facing[k], facing[k + 1]});
  }
  return result;
}

}  // namespace halfshade
