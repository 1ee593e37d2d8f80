#include "meshing/discontinuity/event_jump.h"

#include "meshing/core/planar.h"
#include "meshing/events/margins.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace halfshade {
namespace {

/// What a point sees of a line: the line on the emitter where n·y = 0, y being relative to where
/// the lines meet, and how n·y changes there as the point moves on.
struct SeenLine {
  Vec2 normal;  ///< unit length
  double rate = 0;
};

/// Normal of the plane through the point and a line.
Vec3 sight_plane(const Vec3& point, const Line3& line) {
  return (line.point - point).cross(line.direction);
}

/// Direction in which two lines meet, seen from the point: of the pair that fixes it best.
Vec3 meeting_direction(const std::array<Vec3, 3>& planes) {
  Vec3 best = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 meeting = planes[i].normalized().cross(planes[(i + 1) % 3].normalized());
    if (meeting.squaredNorm() > best.squaredNorm()) best = meeting;
  }
  return best;
}

}  // namespace

// Seen from x, the line (a, d) covers the points q with g(q, x) = ((a − x) × d)·(q − x) = 0. For a
// fixed q, moving x along u changes g by u·(d × (a − q)). With n the part of (a − x) × d in the
// emitter's plane the line therefore is n·y + t u·(d × (a − q)) = 0 there, and three lines
// nᵢ·y + gᵢ t = 0 enclose the area det[nᵢ, gᵢ]² t² / (2 |n₁×n₂| |n₂×n₃| |n₃×n₁|).
double triangle_jump(const ReceivingPoint& at, const PlaneFrame& emitter,
                     const std::array<Line3, 3>& lines) {
  std::array<Vec3, 3> planes;
  for (std::size_t i = 0; i < 3; ++i) planes[i] = sight_plane(at.position, lines[i]);
  const Vec3 w = meeting_direction(planes).stableNormalized();
  const double towards = -emitter.normal.dot(w);
  const Vec3 forward = towards < 0 ? Vec3(-w) : w;
  const double cosine = at.normal.dot(forward), height = emitter.height(at.position);
  if (!(towards != 0 && height > 0 && cosine > 0)) return 0;
  const double distance = height / std::abs(towards);
  const Vec3 meeting = at.position + distance * forward;

  std::array<SeenLine, 3> seen;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2 normal(emitter.e1.dot(planes[i]), emitter.e2.dot(planes[i]));
    const double size = normal.norm();
    if (!(size > 0)) return 0;  // the plane misses the emitter's
    const Vec3 motion = lines[i].direction.cross(lines[i].point - meeting);
    seen[i] = {normal / size, at.across.dot(motion) / size};
  }
  double det = 0, sines = 1;
  int coincide = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double sine = cross_2d(seen[i].normal, seen[(i + 1) % 3].normal);
    det += sine * seen[(i + 2) % 3].rate;
    sines *= std::abs(sine);
    coincide += std::abs(sine) < margins::parallel_sine ? 1 : 0;
  }
  if (coincide >= 2) return 0;
  if (coincide == 1) return std::numeric_limits<double>::infinity();
  const double kernel = cosine * std::abs(towards) / (std::numbers::pi * distance * distance);
  return kernel * det * det / sines;
}

// On the emitter, with y relative to where the lines meet, the horizon is m·y = 0 at height
// z = sin φ m·y, φ being the angle between receiver and emitter, and does not move; the lines are
// n·y + g t = 0 as above. They meet at n₁·y = −g₁ t, n₂·y = −g₂ t, at m·y = h t, and meet the
// horizon a distance b t apart, so that ∫ κ z dA = κ sin φ b h² t³/6 over the triangle.
double horizon_jump(const ReceivingPoint& at, const PlaneFrame& emitter,
                    const std::array<Line3, 2>& lines) {
  const Vec3 first = sight_plane(at.position, lines[0]),
             second = sight_plane(at.position, lines[1]);
  // Both lines pass the point's horizon where they meet: of them the one that crosses it best.
  const Vec3 w1 = first.cross(at.normal), w2 = second.cross(at.normal);
  const Vec3 w =
      (w1.squaredNorm() * second.squaredNorm() > w2.squaredNorm() * first.squaredNorm() ? w1 : w2)
          .stableNormalized();
  const double towards = -emitter.normal.dot(w), height = emitter.height(at.position);
  const Vec2 m(emitter.e1.dot(at.normal), emitter.e2.dot(at.normal));
  const double sine = m.norm();
  if (!(towards != 0 && height > 0 && sine > 0)) return 0;
  const double distance = height / std::abs(towards);
  const Vec3 meeting = at.position + (towards < 0 ? -distance : distance) * w;

  std::array<Vec2, 2> n;
  std::array<double, 2> rate{}, place{};
  const Vec2 along(-m.y() / sine, m.x() / sine);
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 plane = i == 0 ? first : second;
    const Vec2 in_emitter(emitter.e1.dot(plane), emitter.e2.dot(plane));
    const double size = in_emitter.norm();
    if (!(size > 0)) return 0;
    n[i] = in_emitter / size;
    rate[i] = at.across.dot(lines[i].direction.cross(lines[i].point - meeting)) / size;
    const double crossing = n[i].dot(along);
    if (std::abs(crossing) < margins::parallel_sine) return 0;  // runs along the horizon
    place[i] = -rate[i] / crossing;
  }
  const double between = cross_2d(n[0], n[1]);
  if (std::abs(between) < margins::parallel_sine) return std::numeric_limits<double>::infinity();
  const Vec2 apex((rate[1] * n[0].y() - rate[0] * n[1].y()) / between,
                  (rate[0] * n[1].x() - rate[1] * n[0].x()) / between);
  const double h = m.dot(apex) / sine;
  const double kernel = std::abs(towards) / (std::numbers::pi * std::pow(distance, 3));
  return kernel * sine * std::abs(place[0] - place[1]) * h * std::abs(h);
}

// With r the distance from the point to the edge, R that to the emitter behind it, w the direction
// and m the unit normal of the plane of point and edge (to the right of the piece), the image moves
// so that K v dl = (n·w) (u·m) (1/R − 1/r) dφ/π, φ the angle along the piece. Moreover
// 1/R − 1/r = −h/(H r), where h and H are the heights of the edge and of the point over the
// emitter. On the edge, w and h/r both are sums of their values at the ends with the factors
// sin(Ω − φ)/sin Ω and sin φ/sin Ω, Ω being the whole angle, whose products are easy to integrate.
double boundary_motion(const ReceivingPoint& at, const PlaneFrame& emitter, const Vec3& from,
                       const Vec3& to) {
  const Vec3 first = from - at.position, last = to - at.position;
  const double first_length = first.norm(), last_length = last.norm();
  const Vec3 right = first.cross(last);
  const double sine = right.norm() / (first_length * last_length);
  const double height = emitter.height(at.position);
  if (!(sine > 0 && height > 0)) return 0;
  const double cosine = first.dot(last) / (first_length * last_length);
  const double angle = std::atan2(sine, cosine);

  // (Ω − sin Ω cos Ω)/2 and (sin Ω − Ω cos Ω)/2; by their series where they cancel.
  double same = 0.5 * (angle - sine * cosine), mixed = 0.5 * (sine - angle * cosine);
  constexpr double small = 0.25;  // the first terms left out are below 1e-17
  if (angle < small) {
    const double x = angle * angle, y = 4 * x;
    same =
        angle * x / 3 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72 * (1 - y / 110 * (1 - y / 156)))));
    mixed = angle * x / 6 * (1 - x / 10 * (1 - x / 28 * (1 - x / 54 * (1 - x / 88))));
  }
  const double facing_first = at.normal.dot(first) / first_length;
  const double facing_last = at.normal.dot(last) / last_length;
  const double over_first = emitter.height(from) / first_length;
  const double over_last = emitter.height(to) / last_length;
  const double integral = (same * (facing_first * over_first + facing_last * over_last) +
                           mixed * (facing_first * over_last + facing_last * over_first)) /
                          (sine * sine);
  return -at.across.dot(right) / right.norm() * integral / (std::numbers::pi * height);
}

}  // namespace halfshade
