#include "solver/direct/edge_derivatives.h"

#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// Edges at distances that differ by less than this, relatively, meet in space.
constexpr double meeting = 1e-12;

/// A piece seen from the point: p(t) = start + t along for t in [0, 1].
struct Sight {
  Vec3 start, end, along;
  Vec3 plane;  ///< start × along, normal to the plane through the point and the edge

  Sight(const BoundaryPiece& piece, const Vec3& point)
      : start(piece.from - point),
        end(piece.to - point),
        along(piece.to - piece.from),
        plane(start.cross(along)) {}
};

/// What integrals along a piece are made of: with e0 towards the point of the line nearest to x, e1
/// along the line, and φ the angle from e0, p = distance (e0 + tan φ e1).
struct Angles {
  Vec3 e0, e1;
  double distance = 0;  ///< of the line; 0: the line passes through the point
  double length = 0;    ///< |along|
  double cos2 = 0;      ///< ∫ cos² φ dφ
  double sin_cos = 0;   ///< ∫ sin φ cos φ dφ
  double cos4 = 0, sin_cos3 = 0, sin2_cos2 = 0;

  explicit Angles(const Sight& s) {
    length = s.along.norm();
    if (!(length > 0)) return;
    e1 = s.along / length;
    distance = s.plane.norm() / length;
    if (!(distance > 0)) return;
    e0 = e1.cross(s.plane) / (length * distance);
    const double from = std::atan2(e1.dot(s.start), distance);
    const double to = std::atan2(e1.dot(s.end), distance);
    const double angle =
        std::atan2(distance * length, distance * distance + e1.dot(s.start) * e1.dot(s.end));
    // Differences of sines and cosines as products, so that short pieces lose no digits.
    const double sum = from + to;
    const double sin2 = 2 * std::cos(sum) * std::sin(angle);
    const double cos2_step = -2 * std::sin(sum) * std::sin(angle);
    const double sin4 = 2 * std::cos(2 * sum) * std::sin(2 * angle);
    const double cos4_step = -2 * std::sin(2 * sum) * std::sin(2 * angle);
    cos2 = angle / 2 + sin2 / 4;
    sin_cos = -cos2_step / 4;
    cos4 = 3 * angle / 8 + sin2 / 4 + sin4 / 32;
    sin_cos3 = -cos2_step / 8 - cos4_step / 32;
    sin2_cos2 = angle / 8 - sin4 / 32;
  }
};

/// v ↦ v × d as a matrix.
Eigen::Matrix3d cross_with(const Vec3& d) {
  Eigen::Matrix3d m;
  m << 0, d.z(), -d.y(), -d.z(), 0, d.x(), d.y(), -d.x(), 0;
  return m;
}

/// ∇t for an end of a piece on `edge` that lies where `other` crosses it as seen from the point; p
/// is the end and q the same place on the other edge, both relative to the point. Where the edges
/// meet in space the end stays where it is.
Vec3 end_motion(const Sight& edge, const Vec3& p, const Sight& other, const Vec3& q) {
  const double ratio = p.norm() / q.norm();
  const double across = edge.along.dot(other.plane);
  if (std::abs(1 - ratio) < meeting || across == 0) return Vec3::Zero();
  return (1 - ratio) / across * other.plane;
}

class Derivatives {
 public:
  Derivatives(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal) {}

  /// ∫ (n·p) plane / |p|⁴ dt and its derivative for fixed t.
  void add_piece(const Sight& s) {
    const Angles a(s);
    if (!(a.distance > 0)) return;
    const double n0 = normal_.dot(a.e0), n1 = normal_.dot(a.e1);
    const double first = (n0 * a.cos2 + n1 * a.sin_cos) / (a.distance * a.distance * a.length);
    const double scale = 1 / (a.distance * a.distance * a.distance * a.length);
    const Vec3 second = scale * ((n0 * a.cos4 + n1 * a.sin_cos3) * a.e0 +
                                 (n0 * a.sin_cos3 + n1 * a.sin2_cos2) * a.e1);
    result_.gradient += first * s.plane;
    result_.hessian +=
        s.plane * (4 * second - scale * a.cos2 * normal_).transpose() - first * cross_with(s.along);
  }

  /// The first piece ends where the second begins.
  void add_end(const Sight& s, const Sight& next) {
    move_end(s, s.end, end_motion(s, s.end, next, next.start));
    move_end(next, next.start, -end_motion(next, next.start, s, s.end));
  }

  EdgeDerivatives result() const {
    return {-result_.gradient / std::numbers::pi, -result_.hessian / std::numbers::pi};
  }

 private:
  void move_end(const Sight& s, const Vec3& p, const Vec3& motion) {
    const double squared = p.squaredNorm();
    result_.hessian += normal_.dot(p) / (squared * squared) * s.plane * motion.transpose();
  }

  Vec3 point_, normal_;
  EdgeDerivatives result_;
};

}  // namespace

EdgeDerivatives edge_derivatives(const Vec3& point, const Vec3& normal, const VisiblePart& part) {
  Derivatives derivatives(point, normal);
  std::size_t start = 0;
  for (const int chain_end : part.chain_ends) {
    const auto end = static_cast<std::size_t>(chain_end);
    for (std::size_t k = start; k < end; ++k) {
      const BoundaryPiece& piece = part.pieces[k];
      const BoundaryPiece& next = part.pieces[k + 1 < end ? k + 1 : start];
      // Along the horizon n·p vanishes, at the ends of its pieces, too.
      if (piece.edge == EdgeId::horizon()) continue;
      const Sight sight(piece, point);
      derivatives.add_piece(sight);
      if (next.edge != EdgeId::horizon()) derivatives.add_end(sight, Sight(next, point));
    }
    start = end;
  }
  return derivatives.result();
}

}  // namespace halfshade
