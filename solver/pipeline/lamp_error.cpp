#include "solver/pipeline/lamp_error.h"

#include <cmath>

namespace halfshade {
namespace {

Eigen::Map<const Eigen::ArrayXd> areas(const ElementTable& elements) {
  return {elements.area.data(), elements.count()};
}

}  // namespace

double share_beside_lamps(const SolveOptions& options) {
  // Squares sum to less than 1 with those that lamps are cut for.
  constexpr double left = 0.9;
  return options.lamp_error > 0 ? left : 1;
}

double relative_lamp_error(const SolveOptions& options, const ElementField& light,
                           const ElementTable& elements) {
  if (!(options.lamp_error > 0)) return 0;
  const double norm = std::sqrt(square_integral(light, elements));
  return norm > 0 ? options.lamp_error / norm : 0;
}

void add_lamp_error(const SolveOptions& options, AdaptiveField& direct) {
  if (!(options.lamp_error > 0)) return;
  const double before = (areas(direct.elements).sqrt() * direct.error).matrix().stableNorm();
  const double after = std::hypot(before, options.lamp_error);
  if (before > 0)
    direct.error *= after / before;
  else
    direct.error.setConstant(after / std::sqrt(areas(direct.elements).sum()));
  double& relative = direct.report.relative_error;
  relative = std::hypot(relative, relative_lamp_error(options, direct.field, direct.elements));
}

void add_lamp_error(const SolveOptions& options, SolveResult& result) {
  if (!(options.lamp_error > 0)) return;
  const double norm =
      (areas(result.elements).sqrt() * result.solution.irradiance.matrix().rowwise().norm().array())
          .matrix()
          .stableNorm();
  if (norm > 0)
    result.relative_error = std::hypot(result.relative_error, options.lamp_error / norm);
}

}  // namespace halfshade
