#include "meshing/repair/clean_faces.h"

#include "meshing/arrangement/overlay.h"
#include "meshing/core/error.h"
#include "meshing/core/plane_frame.h"
#include "meshing/core/tolerance.h"
#include "meshing/repair/written_digits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace halfshade {
namespace {

// True if the boundary comes back on itself at b, so that b bounds nothing.
bool is_spike(const Vec3& a, const Vec3& b, const Vec3& c, double width) {
  const Vec3 u = a - b, v = c - b;
  if (u.dot(v) <= 0) return false;
  return u.cross(v).norm() <= width * std::max(u.norm(), v.norm());
}

// Welded corners without repetitions and spikes.
std::vector<int> clean_loop(const Face& face, const WeldedVertices& vertices, double width) {
  std::vector<int> loop;
  for (const int v : face.vertices) loop.push_back(vertices.of_vertex[at(v)]);
  // Each removal may make a new spike of its neighbours, so go back one corner after it.
  std::size_t checked = 0, i = 0;
  while (loop.size() >= 3 && checked < loop.size()) {
    const std::size_t n = loop.size();
    const int a = loop[(i + n - 1) % n], b = loop[i], c = loop[(i + 1) % n];
    const bool drop =
        a == b || a == c ||
        is_spike(vertices.points[at(a)], vertices.points[at(b)], vertices.points[at(c)], width);
    if (!drop) {
      i = (i + 1) % n;
      ++checked;
      continue;
    }
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
    i = (i + n - 2) % (n - 1);
    // The corner before the removed one and the one after have to be looked at again.
    checked = 0;
  }
  return loop;
}

std::vector<Vec3> corners(const WeldedVertices& vertices, const std::vector<int>& loop) {
  std::vector<Vec3> result;
  for (const int p : loop) result.push_back(vertices.points[at(p)]);
  return result;
}

LocalScale scale_of_face(const Scene& scene, int face, const WeldedVertices& vertices) {
  const int point = vertices.of_vertex[at(scene.faces[at(face)].vertices.front())];
  const std::vector<Vec3> corners = face_corners(scene, face);
  const Vec3 area = area_vector(corners);
  const double size = area.stableNorm();
  return {vertices.magnitude[at(point)], scale_of(corners).size,
          size > 0 ? rounding_of_plane(corners, area / size) : 0};
}

double perimeter(const std::vector<Vec3>& polygon) {
  double sum = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    sum += (polygon[(k + 1) % polygon.size()] - polygon[k]).norm();
  return sum;
}

// Greatest distance of a corner from the line through the first one and the one farthest from it.
double width_of(const std::vector<Vec3>& polygon) {
  Vec3 chord = Vec3::Zero();
  for (const Vec3& p : polygon)
    if ((p - polygon[0]).norm() > chord.norm()) chord = p - polygon[0];
  double width = 0;
  for (const Vec3& p : polygon) width = std::max(width, (p - polygon[0]).cross(chord).norm());
  return chord.norm() > 0 ? width / chord.norm() : 0;
}

// True if the face has an area worth keeping; throws if its parts cancel.
bool has_area(const Scene& scene, int face, const std::vector<Vec3>& polygon,
              const LocalTolerance& tolerance) {
  if (polygon.size() < 3 || width_of(polygon) <= tolerance.length) return false;
  const double area = area_vector(polygon).norm();
  if (area > 0.5 * tolerance.length * perimeter(polygon)) return true;
  if (polygon.size() == 3) return false;
  reject_crossed_face(scene, face);
}

bool emits(const Scene& scene, int face) {
  return (scene.materials[at(scene.faces[at(face)].material)].exitance > 0).any();
}

// Of faces with the same corners in the same order one stays: an emitter if there is one.
std::vector<FacePiece> without_duplicates(const Scene& scene, std::vector<FacePiece> faces,
                                          std::vector<Repair>& repairs) {
  std::map<std::vector<int>, std::size_t> first;
  std::vector<bool> drop(faces.size(), false);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    std::vector<int> key = faces[i].loop;
    std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
    const auto [entry, is_new] = first.emplace(std::move(key), i);
    if (is_new) continue;
    std::size_t dropped = i, kept = entry->second;
    if (emits(scene, faces[dropped].face) && !emits(scene, faces[kept].face))
      std::swap(dropped, kept);
    entry->second = kept;
    drop[dropped] = true;
    repairs.push_back({Repair::Kind::duplicate_dropped, {faces[dropped].face, faces[kept].face}});
  }
  std::vector<FacePiece> kept;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (!drop[i]) kept.push_back(std::move(faces[i]));
  return kept;
}

// A face off its plane by more than the tolerance, as triangles over its projection.
std::vector<FacePiece> triangles_of(const Scene& scene, const FacePiece& piece,
                                    const PlaneFrame& frame, WeldedVertices& vertices,
                                    const LocalTolerance& tolerance) {
  std::vector<Vec2> flat;
  std::vector<int> ids = piece.loop, local(piece.loop.size());
  for (std::size_t k = 0; k < ids.size(); ++k) {
    flat.push_back(frame.to_plane(vertices.points[at(ids[k])]));
    local[k] = static_cast<int>(k);
  }
  const Overlay result =
      overlay(std::move(flat), std::span(&local, 1), {tolerance.length, tolerance.length});
  if (!crossed_loops(result, tolerance.length).empty()) reject_crossed_face(scene, piece.face);
  for (std::size_t k = ids.size(); k < result.points.size(); ++k) {
    ids.push_back(static_cast<int>(vertices.points.size()));
    vertices.points.push_back(frame.to_space(result.points[k]));
  }
  std::vector<FacePiece> triangles;
  for (std::size_t t = 0; t < result.winding.size(); ++t) {
    if (result.winding[t].empty()) continue;
    const auto& [a, b, c] = result.hull.triangles[t];
    FacePiece triangle{piece.face, {ids[at(a)], ids[at(b)], ids[at(c)]}, piece.scale};
    triangle.scale.size = scale_of(corners(vertices, triangle.loop)).size;
    if (width_of(corners(vertices, triangle.loop)) > tolerance.length)
      triangles.push_back(std::move(triangle));
  }
  return triangles;
}

}  // namespace

void reject_crossed_face(const Scene& scene, int face) {
  throw Error(ErrorCode::invalid_input, scene.source,
              fmt::format("the boundary of {} crosses itself, so that it has no sound interior",
                          face_label(scene, face)));
}

std::vector<FacePiece> clean_faces(const Scene& scene, WeldedVertices& vertices,
                                   std::vector<Repair>& repairs) {
  std::vector<FacePiece> faces;
  for (int f = 0; f < static_cast<int>(scene.faces.size()); ++f) {
    const LocalScale scale = scale_of_face(scene, f, vertices);
    const LocalTolerance tolerance = tolerance_of(scale);
    std::vector<int> loop = clean_loop(scene.faces[at(f)], vertices, tolerance.length);
    if (has_area(scene, f, corners(vertices, loop), tolerance))
      faces.push_back({f, std::move(loop), scale});
    else
      repairs.push_back({Repair::Kind::degenerate_dropped, {f}, tolerance.length});
  }
  faces = without_duplicates(scene, std::move(faces), repairs);
  std::vector<FacePiece> pieces;
  for (FacePiece& face : faces) {
    const std::vector<Vec3> polygon = corners(vertices, face.loop);
    const LocalTolerance tolerance = tolerance_of(face.scale);
    const PlaneFrame frame = fit_plane(polygon);
    double deviation = 0;
    for (const Vec3& p : polygon) deviation = std::max(deviation, std::abs(frame.height(p)));
    if (face.loop.size() == 3 || deviation <= tolerance.planarity) {
      pieces.push_back(std::move(face));
      continue;
    }
    for (FacePiece& t : triangles_of(scene, face, frame, vertices, tolerance))
      pieces.push_back(std::move(t));
    repairs.push_back({Repair::Kind::non_planar_triangulated, {face.face}, deviation});
  }
  return pieces;
}

}  // namespace halfshade
