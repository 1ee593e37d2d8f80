#include "solver/pipeline/common_elements.h"

#include "meshing/core/error.h"
#include "solver/adapt/element_fit.h"
#include "solver/elements/element_lookup.h"
#include "solver/elements/quadrature.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Of a result's error: what being told on other elements may add, as squares.
constexpr double share_of_error = 0.35;
constexpr double least_tolerance = 1e-9;

/// The light of a result at any point of its surfaces.
class LightLookup {
 public:
  explicit LightLookup(const SolveResult& result) : result_(result), lookup_(result.elements) {}

  ForestPlace find(int surface, const Vec3& position) const {
    return lookup_.find(surface, position);
  }
  Rgb irradiance(const ForestPlace& place) const {
    return value(result_.irradiance, result_.solution.irradiance, place);
  }
  Rgb direct(const ForestPlace& place) const {
    return value(result_.direct, result_.solution.direct_irradiance, place);
  }

 private:
  static Rgb value(const ElementField& field, const ChannelArray& means, const ForestPlace& place) {
    if (place.triangle < 0) return Rgb::Zero();
    if (field.count() > 0) return value_at(field, place.triangle, place.place);
    return means.row(place.triangle).transpose();
  }

  const SolveResult& result_;
  ElementLookup lookup_;
};

bool same_elements(const ElementTable& a, const ElementTable& b) {
  return a.corners == b.corners && a.surface == b.surface && a.points == b.points;
}

void require_same_surfaces(const SolveResult& a, const SolveResult& b) {
  const auto same = [](const Surface& s, const Surface& t) { return s.faces == t.faces; };
  if (!std::equal(a.scene.surfaces.begin(), a.scene.surfaces.end(), b.scene.surfaces.begin(),
                  b.scene.surfaces.end(), same))
    throw Error(ErrorCode::invalid_input, {},
                "faces in one plane lie over each other, and which one counts differs from band "
                "to band, for emitters come first; take one of them away");
}

/// Splits the elements of `base` as the light of others takes it.
ElementTable split_elements(const SolveResult& base, const std::vector<SolveResult>& results) {
  ElementTable elements = base.elements;
  if (!base.patches) return elements;
  for (const SolveResult& other : results) {
    if (&other == &base || same_elements(other.elements, elements)) continue;
    const LightLookup light(other);
    AdaptiveFieldOptions options;
    options.tolerance = std::max(share_of_error * other.relative_error, least_tolerance);
    AdaptiveField field = fit_adaptively(
        *base.patches,
        [&](std::span<const FieldPoint> points, const Progress&) {
          std::vector<Rgb> values;
          for (const FieldPoint& point : points)
            values.push_back(light.irradiance(light.find(point.surface, point.point.position)));
          return values;
        },
        options);
    elements = std::move(field.elements);
  }
  return elements;
}

Vec3 centroid(const std::array<Vec3, 3>& triangle) {
  return (triangle[0] + triangle[1] + triangle[2]) / 3;
}

/// The highest order that any result has where each of the elements lies.
std::vector<int> highest_orders(const ElementTable& elements,
                                const std::vector<SolveResult>& results) {
  std::vector<int> order(elements.corners.size(), 0);
  for (const SolveResult& result : results) {
    if (result.irradiance.count() == 0) continue;
    const ElementLookup lookup(result.elements);
    for (int e = 0; e < elements.count(); ++e) {
      const int there =
          lookup.find(elements.surface[at(e)], centroid(elements.triangle(e))).triangle;
      if (there >= 0)
        order[at(e)] = std::max(order[at(e)], std::max(result.irradiance.order[at(there)],
                                                       result.direct.order[at(there)]));
    }
  }
  return order;
}

/// Fits a result's light on other elements.
void put_on(const ElementTable& elements, const std::vector<int>& order, SolveResult& result) {
  const LightLookup light(result);
  ElementField direct = zero_field(order), irradiance = zero_field(order);
  Solution solution;
  solution.error_estimate.resize(elements.count());
  for (int e = 0; e < elements.count(); ++e) {
    const auto triangle = elements.triangle(e);
    const int surface = elements.surface[at(e)];
    const TriangleRule& rule = sampling_rule(order[at(e)]);
    ChannelArray of_direct(rule.weights.size(), 3), of_all(rule.weights.size(), 3);
    for (Eigen::Index k = 0; k < of_all.rows(); ++k) {
      const Vec3 p = position(triangle, rule.places[static_cast<std::size_t>(k)]);
      const ForestPlace place = light.find(surface, p);
      of_all.row(k) = light.irradiance(place).transpose();
      of_direct.row(k) = light.direct(place).transpose();
    }
    const ElementFit fit = fit_element(order[at(e)], of_all);
    irradiance.of(e) = fit.coefficients;
    direct.of(e) = fit_element(order[at(e)], of_direct).coefficients;
    const int there = light.find(surface, centroid(triangle)).triangle;
    solution.error_estimate[e] =
        std::hypot(result.solution.error_estimate[there], fit.error / std::sqrt(3.));
    if (!result.solution.region.empty())
      solution.region.push_back(result.solution.region[at(there)]);
  }
  solution.irradiance = means(irradiance);
  solution.direct_irradiance = means(direct);
  result.solution = std::move(solution);
  if (result.irradiance.count() > 0) {
    result.irradiance = std::move(irradiance);
    result.direct = std::move(direct);
  }
  result.elements = elements;
}

/// Higher degrees of a field as zeros.
ElementField with_orders(const ElementField& field, const std::vector<int>& order) {
  ElementField result = zero_field(order);
  for (int e = 0; e < field.count(); ++e) result.of(e).topRows(field.of(e).rows()) = field.of(e);
  return result;
}

}  // namespace

void share_elements(std::vector<SolveResult>& results) {
  for (const SolveResult& result : results) require_same_surfaces(results.front(), result);
  const bool all_same = std::all_of(results.begin(), results.end(), [&](const SolveResult& result) {
    return same_elements(result.elements, results.front().elements);
  });
  const SolveResult& base = *std::max_element(results.begin(), results.end(),
                                              [](const SolveResult& a, const SolveResult& b) {
                                                return a.elements.count() < b.elements.count();
                                              });
  const ElementTable elements = all_same ? base.elements : split_elements(base, results);
  const std::vector<int> order = highest_orders(elements, results);
  for (SolveResult& result : results)
    if (!all_same) {
      put_on(elements, order, result);
    } else if (result.irradiance.count() > 0) {
      result.irradiance = with_orders(result.irradiance, order);
      result.direct = with_orders(result.direct, order);
    }
}

}  // namespace halfshade
