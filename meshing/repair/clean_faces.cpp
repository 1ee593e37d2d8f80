#include "meshing/repair/clean_faces.h"

#include "meshing/arrangement/overlay.h"
#include "meshing/core/plane_frame.h"
#include "meshing/core/tolerance.h"
#include "meshing/repair/crossed_faces.h"
#include "meshing/repair/written_digits.h"

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

bool is_wide(const std::vector<Vec3>& polygon, const LocalTolerance& tolerance) {
  return polygon.size() >= 3 && width_of(polygon) > tolerance.length;
}

bool has_area(const std::vector<Vec3>& polygon, const LocalTolerance& tolerance) {
  return area_vector(polygon).norm() > 0.5 * tolerance.length * perimeter(polygon);
}

bool emits(const Scene& scene, int face) {
  return (scene.materials[at(scene.faces[at(face)].material)].exitance > 0).any();
}

std::vector<int> from_least(std::vector<int> loop) {
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  return loop;
}

std::vector<int> reversed(std::vector<int> loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

// Of faces with the same corners in the same order one stays: an emitter if there is one.
std::vector<FacePiece> without_duplicates(const Scene& scene, std::vector<FacePiece> faces,
                                          std::vector<Repair>& repairs) {
  std::map<std::vector<int>, std::size_t> first;
  std::vector<bool> drop(faces.size(), false);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto [entry, is_new] = first.emplace(from_least(faces[i].loop), i);
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

// What a face is made of once it is planar.
std::vector<FacePiece> planar_pieces(FacePiece&& face, WeldedVertices& vertices,
                                     std::vector<Repair>& repairs) {
  const std::vector<Vec3> polygon = corners_of(vertices, face.loop);
  const LocalTolerance tolerance = tolerance_of(face.scale);
  if (!has_area(polygon, tolerance)) return split_crossed_face(face, vertices, repairs);
  const PlaneFrame frame = fit_plane(polygon);
  const double deviation = deviation_from(frame, polygon);
  if (polygon.size() == 3 || deviation <= tolerance.planarity) return {std::move(face)};
  const Overlay layout = laid_out(face, frame, vertices, tolerance);
  if (!crossed_loops(layout, tolerance.length).empty())
    return split_crossed_face(face, vertices, repairs);
  repairs.push_back({Repair::Kind::non_planar_triangulated, {face.face}, deviation});
  return triangles_of(face, layout, frame, vertices, tolerance);
}

/// Makes faces planar. A sheet that has a front and a back between the same corners is cut along
/// the same lines on both sides: along others each might lie before the other and hide its light.
class PlanarPieces {
 public:
  PlanarPieces(WeldedVertices& vertices, std::vector<Repair>& repairs)
      : vertices_(vertices), repairs_(repairs) {}

  std::vector<FacePiece> of(FacePiece&& face) {
    const int id = face.face;
    if (const auto front = cut_.find(from_least(reversed(face.loop))); front != cut_.end())
      return back_of(front->second, id);
    std::vector<int> loop = from_least(face.loop);
    const std::size_t repairs = repairs_.size();
    std::vector<FacePiece> pieces = planar_pieces(std::move(face), vertices_, repairs_);
    if (repairs_.size() > repairs) cut_[std::move(loop)] = {pieces, repairs_.back()};
    return pieces;
  }

 private:
  struct Cut {
    std::vector<FacePiece> pieces;
    Repair repair;
  };

  std::vector<FacePiece> back_of(const Cut& front, int face) {
    repairs_.push_back(front.repair);
    repairs_.back().faces = {face};
    std::vector<FacePiece> pieces = front.pieces;
    for (FacePiece& piece : pieces) {
      piece.face = face;
      piece.loop = reversed(std::move(piece.loop));
    }
    return pieces;
  }

  WeldedVertices& vertices_;
  std::vector<Repair>& repairs_;
  std::map<std::vector<int>, Cut> cut_;  ///< by their corners
};

}  // namespace

std::vector<FacePiece> clean_faces(const Scene& scene, WeldedVertices& vertices,
                                   std::vector<Repair>& repairs) {
  std::vector<FacePiece> faces;
  for (int f = 0; f < static_cast<int>(scene.faces.size()); ++f) {
    const LocalScale scale = scale_of_face(scene, f, vertices);
    const LocalTolerance tolerance = tolerance_of(scale);
    std::vector<int> loop = clean_loop(scene.faces[at(f)], vertices, tolerance.length);
    const std::vector<Vec3> polygon = corners_of(vertices, loop);
    // The parts of a wide polygon with more than three corners may cancel.
    if (is_wide(polygon, tolerance) && (polygon.size() > 3 || has_area(polygon, tolerance)))
      faces.push_back({f, std::move(loop), scale});
    else
      repairs.push_back({Repair::Kind::degenerate_dropped, {f}, tolerance.length});
  }
  faces = without_duplicates(scene, std::move(faces), repairs);
  std::vector<FacePiece> pieces;
  PlanarPieces planar(vertices, repairs);
  for (FacePiece& face : faces)
    for (FacePiece& piece : planar.of(std::move(face))) pieces.push_back(std::move(piece));
  return pieces;
}

}  // namespace halfshade
