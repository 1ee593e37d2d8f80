#include "meshing/repair/written_digits.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

// Numbers in single precision have been multiplied and added in it, too, which rounds some times.
constexpr double roundings_in_single = 4;
constexpr int digits_of_single = std::numeric_limits<float>::max_digits10;
/// What programs write at least. Numbers of fewer digits are what somebody meant.
constexpr int fewest_digits = 5;
constexpr int finest_place = -999;

/// Whether a number is one of single precision, or what nine digits, which tell those apart, make
/// of one.
bool is_single(double x) {
  const double single = static_cast<float>(x);
  if (single == x) return true;
  char text[32];
  const char* end = std::to_chars(std::begin(text), std::end(text), single,
                                  std::chars_format::scientific, digits_of_single - 1)
                        .ptr;
  double written = 0;
  std::from_chars(std::begin(text), end, written);
  return written == x;
}

/// Adds a number as the shortest decimal that means it, d.ddde±xx.
void include(WrittenDigits& digits, double x) {
  if (x == 0) return;
  char text[32];
  const char* begin = std::begin(text);
  const char* end =
      std::to_chars(std::begin(text), std::end(text), std::abs(x), std::chars_format::scientific)
          .ptr;
  const char* e = std::find(begin, end, 'e');
  // All but the point.
  const int written = static_cast<int>(e - begin) - (e - begin > 1 ? 1 : 0);
  int exponent = 0;
  std::from_chars(e + 2, end, exponent);
  if (e[1] == '-') exponent = -exponent;
  digits.most = std::max(digits.most, written);
  digits.last_place = std::min(digits.last_place, exponent + 1 - written);
  digits.is_single = digits.is_single && is_single(x);
}

WrittenDigits joint_digits(const WrittenDigits& a, const WrittenDigits& b) {
  return {std::max(a.most, b.most), std::min(a.last_place, b.last_place),
          a.is_single && b.is_single};
}

/// Of the corners of a polygon, axis by axis.
struct Extent {
  Vec3 low, high;

  double magnitude(int axis) const { return std::max(std::abs(low[axis]), std::abs(high[axis])); }
};

Extent extent_of(std::span<const Vec3> points) {
  Extent extent{points[0], points[0]};
  for (const Vec3& p : points) {
    extent.low = extent.low.cwiseMin(p);
    extent.high = extent.high.cwiseMax(p);
  }
  return extent;
}

double rounding_between(const Extent& a, const Extent& b, const Vec3& normal,
                        const WrittenDigits& digits) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (a.low[axis] == a.high[axis] && b.low[axis] == b.high[axis]) continue;
    sum += std::abs(normal[axis]) *
           (rounding_of(a.magnitude(axis), digits) + rounding_of(b.magnitude(axis), digits));
  }
  return sum;
}

}  // namespace

WrittenDigits digits_of(std::span<const Vec3> points) {
  WrittenDigits digits;
  for (const Vec3& p : points)
    for (int axis = 0; axis < 3; ++axis) include(digits, p[axis]);
  return digits;
}

double rounding_of(double magnitude, const WrittenDigits& digits) {
  if (digits.most == 0) return 0;
  double last = std::pow(10., digits.last_place);
  if (!(magnitude > 0)) return last / 2;
  const int first_place = static_cast<int>(std::floor(std::log10(magnitude)));
  last = std::max(last, std::pow(10., first_place + 1 - digits.most));
  constexpr double half_single = std::numeric_limits<float>::epsilon() / 2;
  return std::max(last / 2, digits.is_single ? roundings_in_single * half_single * magnitude : 0.);
}

double rounding_between(std::span<const Vec3> a, std::span<const Vec3> b, const Vec3& normal) {
  return rounding_between(extent_of(a), extent_of(b), normal,
                          joint_digits(digits_of(a), digits_of(b)));
}

double rounding_of_plane(std::span<const Vec3> corners, const Vec3& normal) {
  WrittenDigits digits = digits_of(corners);
  if (digits.most < fewest_digits) digits = {fewest_digits, finest_place, false};
  const Extent extent = extent_of(corners);
  return rounding_between(extent, extent, normal, digits);
}

}  // namespace halfshade
