#include "meshing/backprojection/edge_sum.h"

#include "meshing/backprojection/margins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// θ/sin θ − 1 without cancellation; `sine` ≥ 0.
double angle_excess(double sine, double cosine) {
  const double s = sine * sine;
  // Eight terms of the series of arcsin s / s.
  if (cosine > 0 && s < margins::small_sine_squared)
    return s *
           (1. / 6 +
            s * (3. / 40 +
                 s * (5. / 112 + s * (35. / 1152 +
                                      s * (63. / 2816 + s * (231. / 13312 + s * 143. / 10240))))));
  return std::atan2(sine, cosine) / sine - 1;
}

/// Cuts edges at the horizon and closes the chains along it.
class HorizonClip {
 public:
  HorizonClip(EdgeSum& sum, const Vec3& point, const Vec3& normal)
      : sum_(sum), point_(point), normal_(normal) {}

  void add_ring(const std::vector<Vec3>& ring) {
    left_ = entered_ = false;
    Vec3 a = ring.back() - point_;
    double height_a = normal_.dot(a);
    for (const Vec3& vertex : ring) {
      const Vec3 b = vertex - point_;
      const double height_b = normal_.dot(b);
      add_edge(a, height_a, b, height_b);
      a = b;
      height_a = height_b;
    }
    if (left_ && entered_) sum_.add(exit_, first_entry_);
  }

 private:
  void add_edge(const Vec3& a, double height_a, const Vec3& b, double height_b) {
    if (height_a >= 0 && height_b >= 0) return sum_.add(a, b);
    if (height_a < 0 && height_b < 0) return;
    const Vec3 crossing = (height_a * b - height_b * a) / (height_a - height_b);
    if (height_a >= 0) {
      sum_.add(a, crossing);
      exit_ = crossing;
      left_ = true;
      return;
    }
    // Every exit is joined to the next entry. Where that is not how the clipped polygon's border
    // runs, the superfluous parts along the horizon cancel, for they lie in one plane.
    if (left_) {
      sum_.add(exit_, crossing);
      left_ = false;
    } else {
      first_entry_ = crossing;
      entered_ = true;
    }
    sum_.add(crossing, b);
  }

  EdgeSum& sum_;
  Vec3 point_, normal_;
  Vec3 exit_ = Vec3::Zero(), first_entry_ = Vec3::Zero();
  bool left_ = false;     // an exit has not been joined yet
  bool entered_ = false;  // the first entry came before any exit
};

}  // namespace

EdgeSum::EdgeSum(const Vec3& towards)
    : towards_(towards), length_(towards.norm()), unit_(towards / length_) {}

/// d = a/|a| − c with c the unit vector towards the reference; the difference of the lengths is
/// taken from that of the vectors.
Vec3 EdgeSum::minus_unit(const Vec3& a, double length) const {
  const Vec3 difference = a - towards_;
  const double shorter = -difference.dot(a + towards_) / (length_ + length);  // |c| − |a|
  const Vec3 d = (difference + shorter * unit_) / length;
  // Along c, a difference of unit vectors is −d²/2, which the subtraction only gives up to
  // rounding: that matters for slivers of light at the horizon.
  return d - (0.5 * d.squaredNorm() + unit_.dot(d)) * unit_;
}

void EdgeSum::add(const Vec3& a, const Vec3& b) {
  const double length_a = a.norm(), length_b = b.norm();
  if (!(length_a > 0 && length_b > 0)) return;  // an edge that ends in the point
  sum_ += minus_unit(a, length_a).cross(minus_unit(b, length_b));
  const double scale = 1 / (length_a * length_b);
  const Vec3 cross = scale * a.cross(b - a);
  const double sine = cross.norm();
  // An edge whose line passes through the point contributes nothing.
  if (sine > 0) sum_ += angle_excess(sine, scale * a.dot(b)) * cross;
}

double EdgeSum::form_factor(const Vec3& normal) const {
  return -normal.dot(sum_) / (2 * std::numbers::pi);
}

double unobstructed_factor(const Vec3& point, const Vec3& normal,
                           std::span<const std::vector<Vec3>> rings) {
  EdgeSum sum(rings.front().front() - point);
  HorizonClip clip(sum, point, normal);
  for (const std::vector<Vec3>& ring : rings) clip.add_ring(ring);
  return std::clamp(sum.form_factor(normal), 0., 1.);
}

double enclosed_factor(const Vec3& point, const Vec3& normal,
                       std::span<const BoundaryPiece> pieces) {
  if (pieces.empty()) return 0;
  EdgeSum sum(pieces.front().from - point);
  for (const BoundaryPiece& piece : pieces) sum.add(piece.from - point, piece.to - point);
  return std::clamp(sum.form_factor(normal), 0., 1.);
}

}  // namespace halfshade
