#include "solver/exchange/hemicube.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// A pixel of some area on the cube's surface.
void add_pixel(const Vec3& place, double area, Hemicube& cube) {
  const double r2 = place.squaredNorm();
  // cos at the point z/r, at the pixel 1/r, over π r².
  cube.factors.push_back(place.z() * area / (std::numbers::pi * r2 * r2));
  cube.directions.push_back(place / std::sqrt(r2));
}

}  // namespace

Hemicube make_hemicube(int pixels) {
  if (pixels < 2 || pixels % 2 != 0)
    throw Error(ErrorCode::contract, "make_hemicube",
                fmt::format("{} pixels along an edge; they must be even and at least 2", pixels));
  Hemicube cube;
  const double size = 2. / pixels;
  const auto centre = [&](int k) { return -1 + (k + 0.5) * size; };
  for (int i = 0; i < pixels; ++i)
    for (int j = 0; j < pixels; ++j) add_pixel({centre(i), centre(j), 1}, size * size, cube);
  for (const double side : {-1., 1.})
    for (int i = 0; i < pixels; ++i)
      for (int j = pixels / 2; j < pixels; ++j) {
        add_pixel({side, centre(i), centre(j)}, size * size, cube);
        add_pixel({centre(i), side, centre(j)}, size * size, cube);
      }
  return cube;
}

void add_hemicube(const Hemicube& cube, const HemicubePlace& place, const VisibilityIndex& items,
                  std::span<const Vec3> normals, std::span<double> factors) {
  const Vec3 first = (place.along - place.along.dot(place.normal) * place.normal).normalized();
  Eigen::Matrix3d turn;
  turn << first, place.normal.cross(first), place.normal;
  std::vector<HalfLine> rays;
  rays.reserve(cube.directions.size());
  for (const Vec3& d : cube.directions) rays.push_back({place.point, (turn * d).normalized()});
  std::vector<Hit> hits(rays.size());
  items.first_hits(rays, Sides::both, hits);
  for (std::size_t k = 0; k < hits.size(); ++k) {
    if (hits[k].triangle < 0) continue;
    int owner = hits[k].owner;
    if (normals[at(owner)].dot(rays[k].direction) >= 0) {
      const std::optional<Hit> front = items.facing_hit(rays[k], hits[k]);
      if (!front) continue;
      owner = front->owner;
    }
    factors[at(owner)] += cube.factors[k];
  }
}

}  // namespace halfshade
