#include "solver/pipeline/total_field.h"

#include "meshing/core/parallel.h"
#include "solver/adapt/element_fit.h"
#include "solver/reflected/element_lookup.h"
#include "solver/reflected/reflected_mesh.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace halfshade {
namespace {

/// Direct light at any point of a surface, from its polynomials.
class DirectLookup {
 public:
  explicit DirectLookup(const AdaptiveField& light) : lookup_(light.elements), light_(light) {}

  auto place(int surface, const Vec3& position) const { return lookup_.find(surface, position); }
  Rgb operator()(int surface, const Vec3& position) const {
    const ForestPlace here = place(surface, position);
    // Where light breaks polynomials may dip below zero.
    return here.triangle < 0 ? Rgb(Rgb::Zero())
                             : Rgb(value_at(light_.field, here.triangle, here.place).max(0));
  }

 private:
  ElementLookup lookup_;
  const AdaptiveField& light_;
};

FieldAt values_of(const ReflectedLight& reflected) {
  return [&reflected](std::span<const FieldPoint> points, const Progress& progress) {
    std::vector<Rgb> values(points.size(), Rgb::Zero());
    parallel_for(
        points.size(),
        [&](std::size_t i) {
          values[i] = reflected.irradiance(points[i].surface, points[i].point.position);
        },
        progress, "reflected light on elements");
    return values;
  };
}

/// Order with which direct light is told where it went through the operator.
constexpr int told_order = 2;

/// Direct light that went the way of reflected light, on given elements.
ElementField direct_by_operator(const SoundScene& scene, const ElementTable& elements,
                                ReflectedOptions options, const Progress& progress) {
  options.bounces = 1;
  const ReflectedLight light = reflected_light(scene, {}, options, progress);
  ElementField field =
      zero_field(std::vector<int>(elements.corners.size(), std::min(told_order, options.order)));
  for (int e = 0; e < elements.count(); ++e) {
    const int order = field.order[at(e)];
    const TriangleRule& rule = sampling_rule(order);
    ChannelArray samples(rule.weights.size(), 3);
    for (Eigen::Index k = 0; k < samples.rows(); ++k)
      samples.row(k) = light.irradiance(
          elements.surface[at(e)],
          position(elements.triangle(e), rule.places[static_cast<std::size_t>(k)]));
    field.of(e) = fit_element(order, samples).coefficients;
  }
  return field;
}

/// Coefficients of two polynomials on one element, added.
void add(const ChannelArray& from, Eigen::Ref<ChannelArray> to) { to.topRows(from.rows()) += from; }

}  // namespace

TotalField add_reflected_light(const SoundScene& scene, DirectField direct,
                               const TotalFieldOptions& options, const Progress& progress,
                               Stages& stages) {
  const AdaptiveField& light = direct.light;
  const DirectLookup lookup(light);
  std::optional<ReflectedLight> reflected;
  stages.run("reflected light", [&] {
    reflected = reflected_light(
        scene, [&](int surface, const Vec3& p) { return lookup(surface, p); }, options.reflected,
        progress);
    return static_cast<std::size_t>(reflected->report().elements);
  });
  double area = 0;
  for (const double a : light.elements.area) area += a;
  const double norm = std::sqrt(reflected->report().mean_square_total * area);

  AdaptiveField on_elements;
  stages.run("values of reflected light", [&] {
    AdaptiveFieldOptions fit;
    fit.tolerance = options.values_tolerance;
    fit.norm = norm;
    fit.highest_order = max_reflected_order;
    on_elements = fit_adaptively(*direct.patches, values_of(*reflected), fit, progress);
    return on_elements.elements.corners.size();
  });

  TotalField total;
  total.reflected = reflected->report();
  total.elements = std::move(on_elements.elements);
  const ElementField& extra = on_elements.field;
  std::vector<int> order, whole;
  std::vector<std::array<TrianglePlace, 3>> corners;
  for (int e = 0; e < extra.count(); ++e) {
    const auto triangle = total.elements.triangle(e);
    const int parent =
        lookup.place(total.elements.surface[at(e)], (triangle[0] + triangle[1] + triangle[2]) / 3)
            .triangle;
    whole.push_back(parent);
    order.push_back(std::max(extra.order[at(e)], light.field.order[at(parent)]));
    const auto parent_triangle = light.elements.triangle(parent);
    auto& places = corners.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) places[k] = place_of(parent_triangle, triangle[k]);
  }
  std::vector<int> direct_order;
  for (const int parent : whole) direct_order.push_back(light.field.order[at(parent)]);
  total.direct = zero_field(direct_order);
  total.irradiance = zero_field(std::move(order));
  total.error.resize(extra.count());
  double square_error = 0;
  for (int e = 0; e < extra.count(); ++e) {
    const int parent = whole[at(e)];
    total.direct.of(e) =
        (restriction(direct_order[at(e)], corners[at(e)]) * light.field.of(parent).matrix())
            .array();
    add(total.direct.of(e), total.irradiance.of(e));
    add(extra.of(e), total.irradiance.of(e));
    total.error[e] = std::hypot(light.error[parent], on_elements.error[e]);
    square_error += total.elements.area[at(e)] * total.error[e] * total.error[e];
    if (!direct.region.empty()) total.region.push_back(direct.region[at(parent)]);
  }
  if (options.reflected.through_operator)
    total.direct = direct_by_operator(scene, total.elements, options.reflected, progress);
  const double of_reflected = reflected->report().error;
  const double square = square_integral(total.irradiance, total.elements);
  total.relative_error =
      square > 0 ? std::sqrt(square_error / square + of_reflected * of_reflected) : 0;
  return total;
}

}  // namespace halfshade
