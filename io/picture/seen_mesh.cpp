#include "io/picture/seen_mesh.h"

#include "meshing/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade::detail {
namespace {

void check_arrays(const ShadedMesh& mesh) {
  const std::size_t n = mesh.triangles.size();
  if (mesh.triangle_value.size() != n || mesh.emits.size() != n ||
      (!mesh.point_value.empty() && mesh.point_value.size() != mesh.points.size()) ||
      (!mesh.painted.empty() && mesh.painted.size() != n))
    throw Error(ErrorCode::contract, "draw", "the mesh has arrays of different lengths");
}

}  // namespace

SeenMesh::SeenMesh(const ShadedMesh& mesh, const View& view, Shading shading)
    : mesh_(&mesh), view_(view), shading_(mesh.point_value.empty() ? Shading::flat : shading) {
  check_arrays(mesh);
  if (mesh.triangles.empty()) return;
  index_.emplace(TriangleSoup{mesh.points, mesh.triangles,
                              std::vector<int>(mesh.triangles.size(), 0),
                              std::vector<int>(mesh.triangles.size(), -1)});
}

std::optional<Hit> SeenMesh::cast(const Vec3& origin, const Vec3& ray) const {
  return index_ ? index_->first_hit(origin, ray, Sides::front_only) : std::nullopt;
}

std::array<Vec3, 3> SeenMesh::corners(const Hit& hit) const {
  const auto& t = mesh_->triangles[at(hit.triangle)];
  return {mesh_->points[at(t[0])], mesh_->points[at(t[1])], mesh_->points[at(t[2])]};
}

Rgb SeenMesh::value(const Hit& hit) const {
  if (shading_ == Shading::flat) return triangle_value(hit);
  Rgb value = Rgb::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    value += std::clamp(hit.weights[k], 0.0, 1.0) *
             mesh_->point_value[at(mesh_->triangles[at(hit.triangle)][k])];
  if (mesh_->painted.empty()) return value;
  const ShadedPaint& painted = mesh_->painted[at(hit.triangle)];
  if (painted.paint < 0) return value;
  const auto [a, b, c] = corners(hit);
  const Vec3 seen = hit.weights[0] * a + hit.weights[1] * b + hit.weights[2] * c;
  return value * painted.gain * colour_at(mesh_->paints[at(painted.paint)], seen);
}

Vec3 SeenMesh::normal(const Hit& hit) const {
  const auto [a, b, c] = corners(hit);
  return (b - a).stableNormalized().cross((c - a).stableNormalized()).stableNormalized();
}

/// A ray d meets the line of the edge from a to b where d·((a−o)×(b−o)) = 0, which is linear in
/// pixel coordinates; dividing by the gradient gives the distance in pixels, corners behind the
/// camera or not.
bool SeenMesh::is_on_border(const Hit& hit, const Vec3& ray) const {
  const auto p = corners(hit);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    if (!mesh_->is_border.empty() && !mesh_->is_border[at(hit.triangle)][k]) continue;
    const Vec3 line = (p[k] - view_.origin)
                          .stableNormalized()
                          .cross((p[(k + 1) % 3] - view_.origin).stableNormalized());
    const double gradient = std::hypot(line.dot(view_.right), line.dot(view_.down));
    nearest = std::min(nearest, std::abs(line.dot(ray)) / gradient);
  }
  return nearest < 0.5;
}

/// By rays a little to all sides, for one at the border of a surface may just miss it: the point is
/// seen if one of them ends in a plane through the point.
bool SeenMesh::shows(const Vec3& point) const {
  constexpr double aside = 0.3;        // pixels
  constexpr double same_plane = 1e-5;  // of the distance
  const Vec3 way = point - view_.origin;
  const double distance = way.norm(), depth = view_.forward.dot(way);
  for (const auto& [x, y] : {std::pair{0., 0.}, {1., 0.}, {-1., 0.}, {0., 1.}, {0., -1.}}) {
    const Vec3 ray = way / depth + aside * (x * view_.right + y * view_.down);
    const auto hit = cast(ray);
    if (!hit) continue;
    const Vec3 end = view_.origin + hit->distance * ray.normalized();
    if (std::abs(normal(*hit).dot(point - end)) <= same_plane * distance) return true;
  }
  return false;
}

}  // namespace halfshade::detail
