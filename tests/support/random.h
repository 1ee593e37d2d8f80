#pragma once

#include "meshing/core/types.h"

#include <cstdint>
#include <random>

namespace halfshade::test {

/// Seeded random numbers that come out the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// Uniform in [low, high).
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  /// low, …, high.
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  /// 0, …, count − 1.
  int below(int count) { return static_cast<int>((*this)(0, count)); }
  Vec3 in_box(const Vec3& low, const Vec3& high) {
    return {(*this)(low.x(), high.x()), (*this)(low.y(), high.y()), (*this)(low.z(), high.z())};
  }
  Vec3 point(double low, double high) { return in_box(Vec3::Constant(low), Vec3::Constant(high)); }
  Vec3 direction() {
    for (;;)
      if (const Vec3 v = point(-1, 1); v.squaredNorm() < 1 && v.squaredNorm() > 0.01)
        return v.normalized();
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace halfshade::test
