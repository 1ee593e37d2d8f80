#include "solver/direct/emitter_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace halfshade {
namespace {

/// Where light from the corners of an emitter, or its mean, is more than so many times the least, a
/// share of it by rays of weights that differ as much would be biased.
constexpr double uneven = 3;
/// Parts are narrower than an angle of this cosine, about 59°. No angle of a regular body, so that
/// rounding does not decide.
constexpr double narrow = 0.517;
/// Cosines, and shares of areas, closer to each other or to zero are equal: what they decide must
/// not hang on the rounding of coordinates.
constexpr double alike = 1e-9;
/// Of a triangle in two; what would be cut further is right all the same, but less even.
constexpr int most_halvings = 12;
/// Of a place in [0, 1]: far below the distance between rays.
constexpr double close_enough = 1e-6;
constexpr int most_steps = 20;

bool is_even(const SurfacePoint& point, const EmitterTarget& target, std::span<const Vec3> corners,
             double least, double most) {
  for (const Vec3& corner : corners) {
    const double light = light_along(point, target, corner - point.position);
    least = std::min(least, light);
    most = std::max(most, light);
  }
  return most <= uneven * least;
}

/// A corner of a part.
struct Corner {
  Vec3 way;
  double distance, height;
};

using Corners = std::array<Corner, 3>;

Corner corner_at(const Vec3& from_point, const Vec3& normal) {
  const double distance = from_point.norm();
  const Vec3 way = from_point / distance;
  const double height = normal.dot(way);
  return {way, distance, std::abs(height) < alike ? 0 : height};
}

/// On the edge between two corners, in the direction of a place on the chord between their ways.
Corner between(const Corner& a, const Corner& b, double share, const Vec3& normal) {
  const Vec3 place = (1 - share) * a.way + share * b.way;
  return corner_at(place / ((1 - share) / a.distance + share / b.distance), normal);
}

/// What is above the horizon: three or four corners, or less.
std::vector<Corner> above_horizon(const Corners& triangle, const Vec3& normal) {
  std::vector<Corner> result;
  result.reserve(4);
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner &a = triangle[k], &b = triangle[(k + 1) % 3];
    if (a.height >= 0) result.push_back(a);
    if (!(a.height * b.height < 0)) continue;
    result.push_back(between(a, b, a.height / (a.height - b.height), normal));
    result.back().height = 0;
  }
  return result;
}

/// The widest edge as the point sees it, from this corner to the next; none if all are narrow.
std::optional<std::size_t> wide_edge(const Corners& corners) {
  std::optional<std::size_t> widest;
  double least = narrow;
  for (std::size_t k = 0; k < 3; ++k) {
    const double cosine = corners[k].way.dot(corners[(k + 1) % 3].way);
    if (cosine < least - alike) least = cosine, widest = k;
  }
  return widest;
}

/// Light from the area between the corners is that of the plane through their ways: on it, heights
/// are linear, and what is left is the fourth power of the distance from the point.
void append_part(const Corners& corners, std::vector<EmitterPart>& parts) {
  const auto& [a, b, c] = corners;
  const double middle = (a.way + b.way + c.way).norm() / 3, square = middle * middle;
  const Vec3 first = b.distance * b.way - a.distance * a.way,
             second = c.distance * c.way - a.distance * a.way;
  const double light = (a.height + b.height + c.height) * first.cross(second).norm() /
                       (a.distance * b.distance * c.distance * square * square);
  if (light > 0 && std::isfinite(light))
    parts.push_back({{a.way, b.way, c.way},
                     {a.distance, b.distance, c.distance},
                     {a.height, b.height, c.height},
                     middle,
                     light});
}

/// The point of the corners' plane closest to the point, if it lies between them.
std::optional<Vec3> foot(const Corners& corners) {
  std::array<Vec3, 3> places;
  for (std::size_t k = 0; k < 3; ++k) places[k] = corners[k].distance * corners[k].way;
  const Vec3 normal = (places[1] - places[0]).cross(places[2] - places[0]);
  const double square = normal.squaredNorm();
  if (!(square > 0)) return std::nullopt;
  const Vec3 result = normal.dot(places[0]) / square * normal;
  for (std::size_t k = 0; k < 3; ++k)
    if (normal.dot((places[k] - result).cross(places[(k + 1) % 3] - result)) < -alike * square)
      return std::nullopt;
  return result;
}

void append_narrow(const Corners& corners, const Vec3& normal, int halvings,
                   std::vector<EmitterPart>& parts) {
  const auto wide = halvings > 0 ? wide_edge(corners) : std::nullopt;
  if (!wide) return append_part(corners, parts);
  const Corner &a = corners[*wide], &b = corners[(*wide + 1) % 3], &c = corners[(*wide + 2) % 3];
  const Corner middle = between(a, b, 0.5, normal);
  append_narrow({a, middle, c}, normal, halvings - 1, parts);
  append_narrow({middle, b, c}, normal, halvings - 1, parts);
}

/// Where its plane is closest a part has a corner: no halves of edges would come near.
void append_seen(const Corners& corners, const Vec3& normal, std::vector<EmitterPart>& parts) {
  const auto place = wide_edge(corners) ? foot(corners) : std::nullopt;
  if (!place) return append_narrow(corners, normal, most_halvings, parts);
  const Corner closest = corner_at(*place, normal);
  for (std::size_t k = 0; k < 3; ++k)
    append_narrow({closest, corners[k], corners[(k + 1) % 3]}, normal, most_halvings, parts);
}

/// Below which x a share is, of what is spread over [0, 1] in proportion to x ((1 − x) a + x b).
double place_of_share(double share, double a, double b) {
  double x = std::sqrt(share), low = 0, high = 1;
  for (int k = 0; k < most_steps; ++k) {  // of Newton, or to the middle where those would leave
    const double off = x * x * (3 * a + 2 * (b - a) * x) - share * (a + 2 * b);
    (off > 0 ? high : low) = x;
    const double next = x - off / (6 * x * ((1 - x) * a + x * b));
    const double step = (next > low && next < high ? next : (low + high) / 2) - x;
    x += step;
    if (std::abs(step) < close_enough) break;
  }
  return x;
}

/// The same of what is spread in proportion to (1 − y) a + y b.
double place_on_edge(double share, double a, double b) {
  const double ends = a + std::sqrt((1 - share) * a * a + share * b * b);
  return ends > 0 ? share * (a + b) / ends : share;
}

}  // namespace

double light_along(const SurfacePoint& point, const EmitterTarget& target, const Vec3& way) {
  const double square = way.squaredNorm();
  return std::max(point.normal.dot(way), 0.) * std::max(-target.normal.dot(way), 0.) /
         (square * square);
}

bool is_even(const SurfacePoint& point, const EmitterTarget& target, double area, double factor) {
  const double mean = std::numbers::pi * factor / area;
  return std::all_of(target.rings.begin(), target.rings.end(), [&](const std::vector<Vec3>& ring) {
    return is_even(point, target, ring, mean, mean);
  });
}

void add_parts(const SurfacePoint& point, std::span<const std::array<Vec3, 3>> triangles,
               std::vector<EmitterPart>& parts) {
  for (const std::array<Vec3, 3>& triangle : triangles) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = corner_at(triangle[k] - point.position, point.normal);
    const std::vector<Corner> seen = above_horizon(corners, point.normal);
    for (std::size_t k = 2; k < seen.size(); ++k)
      append_seen({seen[0], seen[k - 1], seen[k]}, point.normal, parts);
  }
}

LightDraw::LightDraw(std::span<const EmitterPart> parts) : parts_(parts) {
  for (const EmitterPart& part : parts) light_ += part.light;
}

LightPoint LightDraw::point(double s, double t) const {
  double along = s * light_;
  std::size_t k = 0;
  for (; k + 1 < parts_.size() && along >= parts_[k].light; ++k) along -= parts_[k].light;
  const EmitterPart& part = parts_[k];
  const auto& [a, b, c] = part.heights;
  const double x = place_of_share(std::clamp(along / part.light, 0., 1.), a, (b + c) / 2);
  const double y = place_on_edge(t, (1 - x) * a + x * b, (1 - x) * a + x * c);
  const std::array<double, 3> shares = {1 - x, x * (1 - y), x * y};
  Vec3 place = Vec3::Zero();
  double nearness = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    place += shares[i] * part.ways[i];
    nearness += shares[i] / part.distances[i];
  }
  const double nearer = part.middle * part.middle / place.squaredNorm();
  return {place / nearness, nearer * nearer};
}

}  // namespace halfshade
