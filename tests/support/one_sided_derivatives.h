#pragma once

#include "meshing/geometry/conic_arc.h"
#include "solver/direct/direct_light.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

/// Jumps of the exact form factor and its derivatives across a line, measured from both sides.
namespace halfshade::test {

struct MeasuredJump {
  std::array<double, 4> jump{};  ///< of F, F′, F″ and F‴, from the right of the line to its left
  std::array<double, 3> from_values{};  ///< the same of nothing but values of F, less precise
  std::array<double, 4> scale{};        ///< the largest |F|, |F′|, |F″| and |F‴| met
  double reach = 0;                     ///< how far the samples go
};

class JumpMeter {
 public:
  JumpMeter(const SoundScene& scene, const DirectLightIndex& index)
      : scene_(scene), index_(index) {}

  /// At a point of a surface, along the unit vector `across`. No other line may be nearer than
  /// `clear`; nothing if the visible part changes its structure within a millionth of the scene.
  std::optional<MeasuredJump> measure(int surface, int emitter, const Vec2& at, const Vec2& across,
                                      double clear) const {
    const PlaneFrame& frame = scene_.surfaces[static_cast<std::size_t>(surface)].frame;
    const Line line{frame.to_space(at), across.x() * frame.e1 + across.y() * frame.e2, frame.normal,
                    emitter};
    const double size = scene_.diagonal;
    for (double reach = std::min(share * clear, longest * size); reach > shortest * size;
         reach *= 0.5) {
      const auto left = sample(line, reach), right = sample(line, -reach);
      if (!left || !right) continue;
      return difference(*left, *right, reach);
    }
    return {};
  }

 private:
  static constexpr double longest = 0.01, shortest = 1e-6;  // relative to the scene's size
  // Of the distance to what may be singular: polynomials converge like 22^-nodes.
  static constexpr double share = 0.2;
  static constexpr std::size_t nodes = 9;

  struct Line {
    Vec3 start, along, normal;
    int emitter;
  };
  using Samples = std::array<std::array<double, nodes>, 3>;  // F, F′, F″ at the nodes

  /// Chebyshev's, in (0, 1).
  static double node(std::size_t i) {
    return 0.5 * (1 - std::cos((static_cast<double>(i) + 0.5) / nodes * std::numbers::pi));
  }

  /// Nothing if not all nodes see the same edges.
  std::optional<Samples> sample(const Line& line, double reach) const {
    Samples samples{};
    std::uint64_t signature = 0;
    for (std::size_t i = 0; i < nodes; ++i) {
      const SurfacePoint point{line.start + reach * node(i) * line.along, line.normal};
      const PointFactorDerivatives f = index_.factor_derivatives(point, line.emitter);
      if (i > 0 && f.factor.signature != signature) return {};
      signature = f.factor.signature;
      samples[0][i] = f.factor.visible;
      samples[1][i] = line.along.dot(f.gradient);
      samples[2][i] = line.along.dot(f.hessian * line.along);
    }
    return samples;
  }

  /// Value and first two derivatives at 0 of the polynomial through the samples, t from 0 to 1: by
  /// Newton's divided differences.
  static std::array<double, 3> at_zero(std::array<double, nodes> y) {
    for (std::size_t order = 1; order < nodes; ++order)
      for (std::size_t i = nodes - 1; i >= order; --i)
        y[i] = (y[i] - y[i - 1]) / (node(i) - node(i - order));
    std::array<double, 3> p{};
    for (std::size_t i = nodes; i-- > 0;) {  // Horner's scheme with derivatives
      const double t = -node(i);
      p[2] = 2 * p[1] + t * p[2];
      p[1] = p[0] + t * p[1];
      p[0] = y[i] + t * p[0];
    }
    return p;
  }

  static MeasuredJump difference(const Samples& left, const Samples& right, double reach) {
    MeasuredJump result;
    result.reach = reach;
    double unit = 1;
    const auto l = at_zero(left[0]), r = at_zero(right[0]);
    for (std::size_t k = 0; k < 3; ++k, unit *= reach) {
      result.jump[k] = at_zero(left[k])[0] - at_zero(right[k])[0];
      result.from_values[k] = (l[k] - (k == 1 ? -r[k] : r[k])) / unit;
      for (std::size_t i = 0; i < nodes; ++i)
        result.scale[k] = std::max({result.scale[k], std::abs(left[k][i]), std::abs(right[k][i])});
    }
    // By the slope of F″; along the right side it is taken backwards.
    const double ahead = at_zero(left[2])[1] / reach, behind = at_zero(right[2])[1] / reach;
    result.jump[3] = ahead + behind;
    result.scale[3] = std::max(std::abs(ahead), std::abs(behind));
    return result;
  }

  const SoundScene& scene_;
  const DirectLightIndex& index_;
};

}  // namespace halfshade::test
