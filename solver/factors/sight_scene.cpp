#include "solver/factors/sight_scene.h"

#include "meshing/core/planar.h"
#include "meshing/geometry/shaft.h"
#include "meshing/triangulation/ring_triangles.h"
#include "solver/factors/body_search.h"
#include "solver/factors/one_blocker.h"

#include <algorithm>
#include <map>
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
  for (const Ring& ring : surface.rings) {
    result.rings.emplace_back();
    for (const Vec2& p : ring) result.rings.back().push_back(surface.frame.to_space(p));
  }
  result.outline = result.rings.front();
  result.pieces = convex_pieces(surface, result.outline);
  for (const Polygon3& piece : result.pieces) result.far_pieces.push_back(far_piece(piece));
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
  for (const Polygon3& piece : result.pieces)
    result.flat_pieces.push_back(flat_piece(piece, surface.frame));
  for (const Vec2& p : whole.rings.front())
    result.magnitude_in_plane = std::max(result.magnitude_in_plane, p.cwiseAbs().maxCoeff());
}

std::array<double, 12> numbers_of(const PlaneFrame& frame) {
  std::array<double, 12> numbers;
  std::size_t k = 0;
  for (const Vec3& v : {frame.origin, frame.e1, frame.e2, frame.normal})
    for (const double x : v) numbers[k++] = x;
  return numbers;
}

VisibilityIndex index_of(TriangleSoup soup) {
  std::iota(soup.owner.begin(), soup.owner.end(), 0);
  return VisibilityIndex(std::move(soup));
}

/// What corners may be off a plane, of their largest coordinate.
constexpr double off_plane = 1e-13;

void measure(Blocker& blocker) {
  const Polygon3& corners = blocker.corners;
  blocker.width = HUGE_VAL;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 along = (corners[(k + 1) % corners.size()] - corners[k]).normalized();
    double width = 0, least = 0, most = 0;
    for (const Vec3& p : corners) {
      width = std::max(width, along.cross(p - corners[k]).norm());
      least = std::min(least, along.dot(p - corners[k]));
      most = std::max(most, along.dot(p - corners[k]));
    }
    if (width >= blocker.width) continue;
    blocker.width = width;
    blocker.along = along;
    blocker.length = most - least;
  }
}

/// A joined surface, or each of its triangles where it is not convex.
void add_blockers(const std::vector<int>& owner, SightScene& scene) {
  const SoundScene& joined = scene.joined.sound;
  const TriangleSoup& soup = scene.between.soup();
  std::vector<int> whole(joined.surfaces.size(), -1);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const Surface& surface = joined.surfaces[at(owner[t])];
    int& known = whole[at(owner[t])];
    if (known < 0) {
      Blocker blocker;
      blocker.normal = surface.frame.normal;
      blocker.rounding = off_plane * surface.scale.magnitude;
      blocker.body = scene.body_of[at(owner[t])];
      if (is_convex(surface))
        for (const Vec2& p : surface.rings.front())
          blocker.corners.push_back(surface.frame.to_space(p));
      else
        for (const int k : soup.triangles[t]) blocker.corners.push_back(soup.points[at(k)]);
      blocker.ball = ball_round(blocker.corners);
      measure(blocker);
      blocker.area = area_vector(blocker.corners).norm();
      scene.blockers.push_back(std::move(blocker));
      if (is_convex(surface)) known = static_cast<int>(scene.blockers.size()) - 1;
    }
    scene.blocker_of.push_back(static_cast<int>(scene.blockers.size()) - 1);
    if (known >= 0) scene.blocker_of.back() = known;
  }
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
  TriangleSoup soup = occluders(joined.sound);
  const std::vector<int> owner = soup.owner;
  VisibilityIndex between = index_of(std::move(soup));
  const auto opaque = std::make_shared<const OpaqueScene>(joined.sound);
  ConvexBodies bodies = find_convex_bodies(joined.sound, *opaque);
  DirectLightIndex light(joined.sound, opaque);
  SightScene result{{},
                    make_reflecting_scene(scene, progress),
                    std::move(joined),
                    std::move(between),
                    {},
                    std::move(bodies.bodies),
                    std::move(bodies.of),
                    {},
                    std::move(light)};
  add_blockers(owner, result);
  std::map<std::array<double, 12>, int> frames;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    SightSurface surface = sight_surface(scene.surfaces[s]);
    surface.same_frame =
        frames.emplace(numbers_of(surface.frame), static_cast<int>(s)).first->second;
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
    const int cell = result.reflecting.cells.before(root);
    if (std::find(surface.cells.begin(), surface.cells.end(), cell) == surface.cells.end())
      surface.cells.push_back(cell);
  }
  return result;
}

bool may_see(const SightScene& scene, int a, int b) {
  const SightSurface &p = scene.surfaces[at(a)], &q = scene.surfaces[at(b)];
  return face_each_other(p, q) && share_a_cell(p, q);
}

namespace {

/// Those of some triangles that may lie between two polygons. Quicker than to look for them in the
/// whole scene where they are some dozens.
Between still_between(const SightScene& scene, const Between& known, std::span<const Vec3> part,
                      std::span<const Vec3> other) {
  const Shaft shaft = make_shaft(part, other, shaft_tolerance(part, other));
  const SideMask sides = all_sides(shaft);
  const TriangleSoup& soup = scene.between.soup();
  Between found;
  int last = -1;
  bool is_beside = false;  // the body that is last
  SideMask rest = sides;   // that it crosses
  for (const int t : known) {
    const int body = scene.blockers[at(scene.blocker_of[at(t)])].body;
    if (body != last) {
      last = body;
      rest = sides;
      is_beside = body >= 0 &&
                  is_outside(shaft, scene.bodies[at(body)].low, scene.bodies[at(body)].high, rest);
    }
    if (is_beside) continue;
    const auto& [i, j, k] = soup.triangles[at(t)];
    if (!is_harmless(shaft, {soup.points[at(i)], soup.points[at(j)], soup.points[at(k)]}, rest))
      found.push_back(t);
  }
  return found;
}

}  // namespace

Sight sight_between_convex(const SightScene& scene, std::span<const Vec3> part, int a,
                           std::span<const Vec3> other, int b, const Between* known,
                           Between& found) {
  const PlaneFrame &p = scene.surfaces[at(a)].frame, &q = scene.surfaces[at(b)].frame;
  const Polygon3 seen = clip_to_front(part, q.origin, q.normal);
  const Polygon3 seeing = clip_to_front(other, p.origin, p.normal);
  if (seen.empty() || seeing.empty()) return Sight::none;
  if (known) {
    if (hides_all(scene, *known, seen, seeing)) return Sight::none;
    if (are_all_beside(scene, *known, seen, seeing)) return Sight::clear;
  }
  found = known ? still_between(scene, *known, seen, seeing)
                : triangles_between(scene, seen, a, seeing, b);
  if (found.empty()) return Sight::clear;
  if ((known && *known == found)) return Sight::partial;
  return hides_all(scene, found, seen, seeing) ? Sight::none : Sight::partial;
}

Sight sight_between(const SightScene& scene, int a, int b) {
  if (!may_see(scene, a, b)) return Sight::none;
  const SightSurface &p = scene.surfaces[at(a)], &q = scene.surfaces[at(b)];
  const bool is_simple = p.pieces.size() * q.pieces.size() <= most_pairs;
  const auto parts = [&](const SightSurface& surface) {
    return is_simple ? std::span(surface.pieces) : std::span(&surface.outline, 1);
  };
  Between found;
  if (parts(p).size() * parts(q).size() == 1)
    return sight_between_convex(scene, parts(p).front(), a, parts(q).front(), b, nullptr, found);
  for (const Polygon3& part : facing(parts(p), q.frame))
    for (const Polygon3& other : facing(parts(q), p.frame))
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

std::vector<int> blockers_between(const SightScene& scene, int a, int b) {
  const SightSurface &p = scene.surfaces[at(a)], &q = scene.surfaces[at(b)];
  const std::vector<Polygon3> others = facing(q.pieces, p.frame);
  std::vector<int> blockers;
  for (const Polygon3& part : facing(p.pieces, q.frame))
    for (const Polygon3& other : others)
      for (const int t : triangles_between(scene, part, a, other, b))
        blockers.push_back(scene.blocker_of[at(t)]);
  std::sort(blockers.begin(), blockers.end());
  blockers.erase(std::unique(blockers.begin(), blockers.end()), blockers.end());
  return blockers;
}

bool in_all_cells_of(const SightScene& scene, int a, int b) {
  const std::vector<int>& others = scene.surfaces[at(b)].cells;
  return std::all_of(
      scene.surfaces[at(a)].cells.begin(), scene.surfaces[at(a)].cells.end(),
      [&](int cell) { return std::find(others.begin(), others.end(), cell) != others.end(); });
}

FacingTriangles facing_triangles(const SightScene& scene, int a, int b) {
  const SightSurface &p = scene.surfaces[at(a)], &q = scene.surfaces[at(b)];
  // What hides things from points of a surface is asked in its plane; corners that it shares with
  // others may lie off it by rounding.
  const PlaneFrame& plane = scene.joined.sound.surfaces[at(p.joined)].frame;
  FacingTriangles result;
  result.is_all = in_all_cells_of(scene, a, b);
  for (const int root : p.roots) {
    const int cell = scene.reflecting.cells.before(root);
    if (std::find(q.cells.begin(), q.cells.end(), cell) == q.cells.end()) continue;
    std::array<Vec3, 3> triangle = scene.reflecting.roots.triangle(root);
    for (Vec3& corner : triangle) corner = plane.foot(corner);
    const Polygon3 facing = clip_to_front(triangle, q.frame.origin, q.frame.normal);
    for (std::size_t k = 1; k + 1 < facing.size(); ++k)
      result.triangles.push_back({facing[0], facing[k], facing[k + 1]});
  }
  return result;
}

bool is_clear_in_cells(const SightScene& scene, int a, int b) {
  if (in_all_cells_of(scene, a, b) && in_all_cells_of(scene, b, a)) return false;
  Polygon3 part, other;
  for (const Triangle3& t : facing_triangles(scene, a, b).triangles)
    part.insert(part.end(), t.begin(), t.end());
  for (const Triangle3& t : facing_triangles(scene, b, a).triangles)
    other.insert(other.end(), t.begin(), t.end());
  return !part.empty() && !other.empty() && triangles_between(scene, part, a, other, b).empty();
}

}  // namespace halfshade
