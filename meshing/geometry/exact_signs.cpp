#include "meshing/geometry/exact_signs.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <utility>

namespace halfshade {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 to_cgal(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Signs of the polynomials in p − eye, q − eye that the determinant's expansion asks for.
struct Signs {
  const Vec3& eye;

  int coordinate(const Vec3& p, int axis) const {
    return p[axis] > eye[axis] ? 1 : p[axis] < eye[axis] ? -1 : 0;
  }
  /// Sign of component `axis` of (p − eye) × (q − eye).
  int cross(const Vec3& p, const Vec3& q, int axis) const {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return static_cast<int>(CGAL::orientation(
        Kernel::Point_2(eye[u], eye[v]), Kernel::Point_2(p[u], p[v]), Kernel::Point_2(q[u], q[v])));
  }
  int determinant(const Vec3& a, const Vec3& b, const Vec3& c) const {
    // orientation(a, b, c, eye) is the sign of det(b − a, c − a, eye − a).
    return -static_cast<int>(CGAL::orientation(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(eye)));
  }
};

/// Sign of the determinant of a, b, c once each coordinate is displaced by an infinitesimal amount
/// of its own, a's x being displaced most and c's z least, each by less than any product of the
/// larger ones. The terms of the expansion, in order of size, up to the first that is not zero.
int perturbed_determinant(const Signs& sign, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (const int s = sign.determinant(a, b, c)) return s;
  for (int k = 0; k < 3; ++k)
    if (const int s = sign.cross(b, c, k)) return s;  // a_k
  for (int k = 0; k < 3; ++k) {
    if (const int s = sign.cross(c, a, k)) return s;  // b_k
    for (int j = 0; j < 3; ++j) {                     // b_k a_j
      if (j == k) continue;
      const int left = 3 - j - k;
      const int parity = (k - j + 3) % 3 == 1 ? 1 : -1;
      if (const int s = sign.coordinate(c, left)) return parity * s;
    }
  }
  // c lies at the eye.
  for (int k = 0; k < 3; ++k) {
    if (const int s = sign.cross(a, b, k)) return s;  // c_k
    for (int j = 0; j < 3; ++j) {                     // c_k a_j
      if (j == k) continue;
      const int parity = (j - k + 3) % 3 == 1 ? 1 : -1;
      if (const int s = sign.coordinate(b, 3 - j - k)) return parity * s;
    }
    for (int j = 0; j < 3; ++j) {  // c_k b_j, then c_k b_j a_i
      if (j == k) continue;
      const int parity = (k - j + 3) % 3 == 1 ? 1 : -1;
      if (const int s = sign.coordinate(a, 3 - j - k)) return parity * s;
      return parity;
    }
  }
  return 1;  // not reached
}

}  // namespace

int turn_exactly(const Vec3& eye, const SeenPoint& a, const SeenPoint& b, const SeenPoint& c) {
  std::array<const SeenPoint*, 3> p = {&a, &b, &c};
  int parity = -1;  // counter-clockwise is a negative determinant
  const auto order = [&](std::size_t i, std::size_t j) {
    if (p[i]->rank > p[j]->rank) {
      std::swap(p[i], p[j]);
      parity = -parity;
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return parity * perturbed_determinant(Signs{eye}, p[0]->position, p[1]->position, p[2]->position);
}

}  // namespace halfshade
