#include "meshing/repair/repair.h"

#include "meshing/arrangement/overlay.h"
#include "meshing/core/error.h"
#include "meshing/core/planar.h"
#include "meshing/repair/canonical_order.h"
#include "meshing/repair/clean_faces.h"
#include "meshing/repair/contacts.h"
#include "meshing/repair/coplanar.h"
#include "meshing/repair/crossed_faces.h"
#include "meshing/repair/narrow_gaps.h"
#include "meshing/repair/planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace halfshade {
namespace {

// The same plane seen from its other side: coordinates are mirrored exactly.
PlaneFrame turned(const PlaneFrame& frame) {
  return {frame.origin, frame.e1, -frame.e2, -frame.normal};
}

// A piece, or its back, as one of the faces that look to one side of a plane.
CoplanarFace coplanar_face(const Scene& scene, const FacePiece& piece,
                           const std::vector<Vec3>& polygon, bool back) {
  const Face& face = scene.faces[at(piece.face)];
  CoplanarFace result;
  result.face = piece.face;
  result.material = face.material;
  result.group = face.group;
  result.paint = face.paint;
  result.back = back;
  result.emits = (scene.materials[at(face.material)].exitance > 0).any();
  result.area = area_vector(polygon).norm();
  result.scale = piece.scale;
  result.loop = piece.loop;
  if (back) std::reverse(result.loop.begin(), result.loop.end());
  return result;
}

using PlaneSides = std::vector<std::array<std::vector<CoplanarFace>, 2>>;

PlaneSides sort_into_sides(const Scene& scene, const std::vector<FacePiece>& pieces,
                           const PlaneClasses& classes, const std::vector<Vec3>& points) {
  PlaneSides sides(classes.frames.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::vector<Vec3> polygon;
    for (const int p : pieces[i].loop) polygon.push_back(points[at(p)]);
    const int plane = classes.of_polygon[i];
    const std::size_t side = area_vector(polygon).dot(classes.frames[at(plane)].normal) > 0 ? 0 : 1;
    sides[at(plane)][side].push_back(coplanar_face(scene, pieces[i], polygon, false));
    if (scene.materials[at(scene.faces[at(pieces[i].face)].material)].two_sided)
      sides[at(plane)][1 - side].push_back(coplanar_face(scene, pieces[i], polygon, true));
  }
  return sides;
}

void report_merge(const SurfaceDraft& draft, std::vector<Repair>& repairs) {
  std::vector<int> faces = draft.faces;
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  if (faces.size() < 2 || draft.back) return;
  repairs.push_back({Repair::Kind::coplanar_merged, std::move(faces)});
}

void report_overlap(const CoveredPair& pair, std::vector<Repair>& repairs) {
  if (!pair.backs)
    repairs.push_back({Repair::Kind::overlap_removed, {pair.keeper, pair.loser}, pair.area});
}

/// The signed area of a ring once its corners are rounded in its frame.
double area_of_ring(const SurfaceDraft& draft, const std::vector<int>& ring,
                    const std::vector<Vec3>& points) {
  const auto place = [&](int p) { return draft.frame.to_plane(points[at(p)]); };
  const Vec2 first = place(ring.front());
  double twice = 0;
  for (std::size_t k = 1; k < ring.size(); ++k)
    twice += cross_2d(place(ring[k - 1]) - first, place(ring[k]) - first);
  return twice / 2;
}

/// Holes that snapping has shut.
void drop_shut_holes(SurfaceDraft& draft, const std::vector<Vec3>& points) {
  const auto shut = std::remove_if(
      draft.rings.begin() + 1, draft.rings.end(),
      [&](const std::vector<int>& ring) { return !(area_of_ring(draft, ring, points) < 0); });
  draft.rings.erase(shut, draft.rings.end());
}

// Faces that snapping left nothing of, though nothing covers them.
void report_lost(const PlaneSides& sides, const std::vector<SurfaceDraft>& drafts,
                 std::vector<Repair>& repairs) {
  std::set<int> kept;
  for (const SurfaceDraft& draft : drafts) kept.insert(draft.faces.begin(), draft.faces.end());
  for (const Repair& repair : repairs) kept.insert(repair.faces.begin(), repair.faces.end());
  for (const auto& plane : sides)
    for (const auto& side : plane)
      for (const CoplanarFace& face : side)
        if (kept.insert(face.face).second)
          repairs.push_back(
              {Repair::Kind::degenerate_dropped, {face.face}, tolerance_of(face.scale).planarity});
}

/// The surfaces that pieces make, unless some faces cross themselves.
struct Drafts {
  std::vector<SurfaceDraft> drafts;
  std::vector<Repair> repairs;
  std::vector<int> crossed;  ///< input faces, sorted
};

Drafts make_drafts(const Scene& scene, const std::vector<FacePiece>& pieces,
                   std::vector<Vec3>& points, std::vector<Repair> repairs) {
  std::vector<std::vector<int>> loops;
  std::vector<LocalScale> scales;
  std::vector<bool> two_sided;
  for (const FacePiece& piece : pieces) {
    loops.push_back(piece.loop);
    scales.push_back(piece.scale);
    two_sided.push_back(scene.materials[at(scene.faces[at(piece.face)].material)].two_sided);
  }
  const PlaneClasses classes = classify_planes(points, loops, scales, two_sided);
  report_shut_gaps(scene, pieces, classes, repairs);
  report_narrow_gaps(scene, pieces, classes, repairs);
  const PlaneSides sides = sort_into_sides(scene, pieces, classes, points);
  std::vector<SurfaceDraft> drafts;
  std::set<int> crossed;
  for (std::size_t plane = 0; plane < sides.size(); ++plane)
    for (std::size_t side = 0; side < 2; ++side) {
      if (sides[plane][side].empty()) continue;
      const PlaneFrame& front = classes.frames[plane];
      CoplanarResult result =
          resolve_coplanar(points, side == 0 ? front : turned(front), sides[plane][side]);
      crossed.insert(result.crossed.begin(), result.crossed.end());
      for (const CoveredPair& pair : result.covered) report_overlap(pair, repairs);
      for (SurfaceDraft& draft : result.drafts) {
        draft.plane = static_cast<int>(plane);
        drafts.push_back(std::move(draft));
      }
    }
  if (!crossed.empty()) return {{}, {}, {crossed.begin(), crossed.end()}};
  // In the order of the file, which is what a user expects to find.
  std::stable_sort(drafts.begin(), drafts.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.faces.front(), a.back) < std::tuple(b.faces.front(), b.back);
  });
  for (const SurfaceDraft& draft : drafts) report_merge(draft, repairs);
  report_lost(sides, drafts, repairs);
  return {std::move(drafts), std::move(repairs), {}};
}

/// The surfaces of a scene. That a planar face crosses itself is found out where those of its plane
/// are laid over each other: it is split then, and they are laid over each other once more.
std::vector<SurfaceDraft> drafts_of(const Scene& scene, WeldedVertices& vertices,
                                    std::vector<Repair>& repairs) {
  std::vector<FacePiece> pieces = clean_faces(scene, vertices, repairs);
  std::size_t points = vertices.points.size();
  Drafts made = make_drafts(scene, pieces, vertices.points, repairs);
  // Others may come to cross themselves as corners snap to those of parts.
  while (!made.crossed.empty()) {
    vertices.points.resize(points);
    pieces = with_crossed_faces_split(std::move(pieces), made.crossed, vertices, repairs);
    points = vertices.points.size();
    made = make_drafts(scene, pieces, vertices.points, repairs);
  }
  repairs = std::move(made.repairs);
  return std::move(made.drafts);
}

Surface finish(SurfaceDraft&& draft, const std::vector<Vec3>& points) {
  Surface surface;
  surface.frame = draft.frame;
  surface.scale = draft.scale;
  surface.material = draft.material;
  surface.group = draft.group;
  surface.paint = draft.paint;
  surface.plane = draft.plane;
  surface.back = draft.back;
  surface.faces = std::move(draft.faces);
  const auto place = [&](int p) { return draft.frame.to_plane(points[at(p)]); };
  const auto ring = [&](const std::vector<int>& loop) {
    Ring result;
    for (const int p : loop) result.push_back(place(p));
    return result;
  };
  for (const auto& loop : draft.rings) surface.rings.push_back(ring(loop));
  for (const auto& loop : draft.face_rings) surface.face_rings.push_back(ring(loop));
  for (const auto& [a, b] : draft.contacts) surface.contacts.push_back({place(a), place(b)});
  return surface;
}

}  // namespace

SoundScene make_sound(const Scene& scene, const RepairOptions& options) {
  SoundScene sound;
  sound.materials = scene.materials;
  sound.paints = scene.paints;
  sound.groups = scene.groups;
  for (const Face& face : scene.faces) sound.face_lines.push_back(face.line);
  sound.diagonal = diagonal(scene);
  WeldedVertices vertices = weld(scene);
  std::vector<SurfaceDraft> drafts = drafts_of(scene, vertices, sound.repairs);
  if (static_cast<double>(drafts.size()) > options.most_surfaces)
    throw Error(ErrorCode::too_large, {},
                fmt::format("there are {} surfaces, and {} are allowed", drafts.size(),
                            options.most_surfaces));
  if (options.contacts) find_contacts(drafts, vertices.points, options.most_contacts);
  for (SurfaceDraft& draft : drafts) {
    // What snaps in one plane may have corners in others.
    drop_shut_holes(draft, vertices.points);
    if (area_of_ring(draft, draft.rings.front(), vertices.points) > 0)
      sound.surfaces.push_back(finish(std::move(draft), vertices.points));
    else if (!draft.back)
      sound.repairs.push_back({Repair::Kind::degenerate_dropped,
                               {draft.faces.front()},
                               tolerance_of(draft.scale).planarity});
  }
  if (sound.surfaces.empty())
    throw Error(ErrorCode::invalid_input, scene.source,
                fmt::format("none of its {} faces has an area", scene.faces.size()));
  return sound;
}

SoundScene make_sound_in_any_order(const Scene& scene, const RepairOptions& options) {
  const OrderedScene ordered = in_canonical_order(scene);
  SoundScene sound = make_sound(ordered.scene, options);
  const auto rename = [&](std::vector<int>& faces) {
    for (int& face : faces) face = ordered.face[at(face)];
  };
  for (Surface& surface : sound.surfaces) rename(surface.faces);
  for (Repair& repair : sound.repairs) rename(repair.faces);
  for (std::size_t f = 0; f < scene.faces.size(); ++f) sound.face_lines[f] = scene.faces[f].line;
  return sound;
}

}  // namespace halfshade
