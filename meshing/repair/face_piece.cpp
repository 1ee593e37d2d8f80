#include "meshing/repair/face_piece.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace halfshade {

std::vector<Vec3> corners_of(const WeldedVertices& vertices, const std::vector<int>& loop) {
  std::vector<Vec3> result;
  for (const int p : loop) result.push_back(vertices.points[at(p)]);
  return result;
}

double width_of(const std::vector<Vec3>& polygon) {
  Vec3 chord = Vec3::Zero();
  for (const Vec3& p : polygon)
    if ((p - polygon[0]).norm() > chord.norm()) chord = p - polygon[0];
  double width = 0;
  for (const Vec3& p : polygon) width = std::max(width, (p - polygon[0]).cross(chord).norm());
  return chord.norm() > 0 ? width / chord.norm() : 0;
}

double deviation_from(const PlaneFrame& frame, const std::vector<Vec3>& polygon) {
  double deviation = 0;
  for (const Vec3& p : polygon) deviation = std::max(deviation, std::abs(frame.height(p)));
  return deviation;
}

Overlay laid_out(const FacePiece& piece, const PlaneFrame& frame, const WeldedVertices& vertices,
                 const LocalTolerance& tolerance) {
  std::vector<Vec2> flat;
  for (const int p : piece.loop) flat.push_back(frame.to_plane(vertices.points[at(p)]));
  std::vector<int> loop(flat.size());
  std::iota(loop.begin(), loop.end(), 0);
  return overlay(std::move(flat), std::span(&loop, 1), {tolerance.length, tolerance.length});
}

std::vector<FacePiece> triangles_of(const FacePiece& piece, const Overlay& layout,
                                    const PlaneFrame& frame, WeldedVertices& vertices,
                                    const LocalTolerance& tolerance) {
  std::vector<int> ids = piece.loop;
  for (std::size_t k = ids.size(); k < layout.points.size(); ++k) {
    ids.push_back(static_cast<int>(vertices.points.size()));
    vertices.points.push_back(frame.to_space(layout.points[k]));
  }
  std::vector<FacePiece> triangles;
  for (std::size_t t = 0; t < layout.winding.size(); ++t) {
    if (layout.winding[t].empty()) continue;
    auto [a, b, c] = layout.hull.triangles[t];
    if (layout.winding[t].front().second < 0) std::swap(b, c);
    FacePiece triangle = triangle_of(piece, ids[at(a)], ids[at(b)], ids[at(c)], vertices);
    if (width_of(corners_of(vertices, triangle.loop)) > tolerance.length)
      triangles.push_back(std::move(triangle));
  }
  return triangles;
}

FacePiece triangle_of(const FacePiece& piece, int a, int b, int c, const WeldedVertices& vertices) {
  FacePiece triangle{piece.face, {a, b, c}, piece.scale};
  triangle.scale.size = scale_of(corners_of(vertices, triangle.loop)).size;
  return triangle;
}

}  // namespace halfshade
