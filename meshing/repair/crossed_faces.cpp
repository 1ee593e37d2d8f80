#include "meshing/repair/crossed_faces.h"

#include "meshing/geometry/skew_polygon.h"

#include <algorithm>
#include <utility>

namespace halfshade {
namespace {

// Triangles between so many corners in space take a tenth of a second.
constexpr std::size_t most_in_space = 200;

// The plane of the largest triangle at the first corner. The area vector of a face that crosses
// itself tells none: what its parts look like cancels.
PlaneFrame plane_of_largest_triangle(const std::vector<Vec3>& polygon) {
  Vec3 largest = Vec3::Zero();
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Vec3 area = (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]);
    if (area.norm() > largest.norm()) largest = area;
  }
  return make_frame(polygon[0], largest);
}

std::vector<FacePiece> triangles_in_space(const FacePiece& face, const std::vector<Vec3>& polygon,
                                          const WeldedVertices& vertices,
                                          const LocalTolerance& tolerance) {
  std::vector<FacePiece> triangles;
  for (const auto& [a, b, c] : triangulate_skew_polygon(polygon)) {
    FacePiece triangle =
        triangle_of(face, face.loop[at(a)], face.loop[at(b)], face.loop[at(c)], vertices);
    if (width_of(corners_of(vertices, triangle.loop)) > tolerance.length)
      triangles.push_back(std::move(triangle));
  }
  return triangles;
}

}  // namespace

std::vector<FacePiece> split_crossed_face(const FacePiece& face, WeldedVertices& vertices,
                                          std::vector<Repair>& repairs) {
  const std::vector<Vec3> polygon = corners_of(vertices, face.loop);
  const LocalTolerance tolerance = tolerance_of(face.scale);
  const PlaneFrame frame = plane_of_largest_triangle(polygon);
  const double deviation = deviation_from(frame, polygon);
  std::vector<FacePiece> triangles =
      deviation <= tolerance.planarity || polygon.size() > most_in_space
          ? triangles_of(face, laid_out(face, frame, vertices, tolerance), frame, vertices,
                         tolerance)
          : triangles_in_space(face, polygon, vertices, tolerance);
  if (triangles.empty())
    repairs.push_back({Repair::Kind::degenerate_dropped, {face.face}, tolerance.planarity});
  else
    repairs.push_back({Repair::Kind::crossed_split, {face.face}});
  return triangles;
}

std::vector<FacePiece> with_crossed_faces_split(std::vector<FacePiece> pieces,
                                                std::span<const int> crossed,
                                                WeldedVertices& vertices,
                                                std::vector<Repair>& repairs) {
  std::vector<FacePiece> result;
  for (FacePiece& piece : pieces) {
    if (!std::binary_search(crossed.begin(), crossed.end(), piece.face)) {
      result.push_back(std::move(piece));
      continue;
    }
    for (FacePiece& triangle : split_crossed_face(piece, vertices, repairs))
      result.push_back(std::move(triangle));
  }
  return result;
}

}  // namespace halfshade
