#include "solver/pipeline/total_field.h"

#include "meshing/core/parallel.h"
#include "solver/adapt/element_fit.h"
#include "solver/elements/balancing_scale.h"
#include "solver/pipeline/field_lookup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace halfshade {
namespace {

/// Direct light, and where it is asked for.
struct FoundLight {
  explicit FoundLight(AdaptiveField found)
      : light(std::move(found)), lookup(light.elements, light.field) {}

  AdaptiveField light;
  FieldLookup lookup;
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

/// The middles of its elements: where they are small it changes within lengths that samples on
/// those of direct light may overlook, as above a lamp close below a ceiling.
Watched middles_of(const ReflectedLight& reflected) {
  const ElementTable& elements = reflected.elements();
  Watched watched;
  for (int e = 0; e < elements.count(); ++e) {
    const auto [a, b, c] = elements.triangle(e);
    const SurfacePoint middle{(a + b + c) / 3, elements.normal[at(e)]};
    watched.places.push_back({{middle, elements.surface[at(e)]}, elements.area[at(e)]});
  }
  return watched;
}

/// Order with which direct light is told where it went through the operator.
constexpr int told_order = 2;

/// A function of element and position as polynomials on given elements; zero where it was stopped.
template <class Value>
ElementField fitted(const ElementTable& elements, std::vector<int> orders, const Value& value,
                    const Progress& progress = {}) {
  ElementField field = zero_field(std::move(orders));
  parallel_for(
      elements.corners.size(),
      [&](std::size_t i) {
        const int e = static_cast<int>(i), order = field.order[i];
        const TriangleRule& rule = sampling_rule(order);
        ChannelArray samples(rule.weights.size(), 3);
        for (Eigen::Index k = 0; k < samples.rows(); ++k)
          samples.row(k) =
              value(e, position(elements.triangle(e), rule.places[static_cast<std::size_t>(k)]));
        field.of(e) = fit_element(order, samples).coefficients;
      },
      progress, "final gather");
  return field;
}

/// Unless it is asked for, a final gather takes no more than so many times what finding the
/// solution took: rays, or points whose exactly visible parts are looked for; or so few of them.
constexpr double most_of_solution = 3, few_rays = 5e6, few_points = 5000;

/// Rays whose noise is half of what polynomials are allowed to be off.
int rays_of_gather(double tolerance) { return gathering_rays(tolerance / 2); }

/// What a final gather takes, relative to finding the solution; 0 if that is little.
double share_of_gather(const ReflectedReport& report, const ElementField& polynomials,
                       double tolerance) {
  double points = 0;
  for (const int order : polynomials.order)
    points += static_cast<double>(sampling_rule(order).weights.size());
  const double work = report.is_exact ? points : points * rays_of_gather(tolerance);
  if (work <= (report.is_exact ? few_points : few_rays)) return 0;
  return work / static_cast<double>(report.is_exact ? report.unknowns : report.rays);
}

/// Whether a final gather makes light better that is not as exact as was asked for.
bool would_help(const ReflectedReport& report) {
  return report.end != ReflectedEnd::accurate && report.end != ReflectedEnd::nothing &&
         report.end != ReflectedEnd::interrupted;
}

/// What arrives of a solution, on elements and of orders that suit its polynomials.
ElementField gathered(const ReflectedLight& light, const AdaptiveField& polynomials,
                      double tolerance, const Progress& progress) {
  const int rays = rays_of_gather(tolerance);
  const ElementTable& elements = polynomials.elements;
  return fitted(
      elements, polynomials.field.order,
      [&](int e, const Vec3& p) { return light.gather_on(elements.surface[at(e)], p, rays); },
      progress);
}

/// Direct light that went the way of reflected light, on given elements: what exact parts know of
/// it from all light, `whole`; rays, which must not be noisy, look once more.
ElementField direct_by_operator(const SoundScene& scene, const ElementTable& elements,
                                const ReflectedLight& whole, ReflectedOptions options,
                                const Progress& progress) {
  const std::vector<int> orders(elements.corners.size(), std::min(told_order, options.order));
  if (whole.bounces() > 0)
    return fitted(elements, orders, [&](int e, const Vec3& p) {
      return whole.irradiance_after(1, elements.surface[at(e)], p);
    });
  options.bounces = 1;
  options.each_bounce = false;
  const ReflectedLight light = reflected_light(scene, {}, options, progress);
  return fitted(elements, orders,
                [&](int e, const Vec3& p) { return light.irradiance(elements.surface[at(e)], p); });
}

/// The parts of `field`, all of `light` on given elements, by the number of reflections.
std::vector<ElementField> told_apart(const ReflectedLight& light, const ElementTable& elements,
                                     const ElementField& field) {
  std::vector<ElementField> parts = {field};
  for (int n = 2; n <= light.bounces(); ++n) {
    parts.push_back(fitted(elements, field.order, [&](int e, const Vec3& p) {
      return light.irradiance_after(n, elements.surface[at(e)], p);
    }));
    parts[0].coefficients -= parts.back().coefficients;
  }
  return parts;
}

/// Coefficients of two polynomials on one element, added.
void add(const ChannelArray& from, Eigen::Ref<ChannelArray> to) { to.topRows(from.rows()) += from; }

/// The elements of direct light that others are parts of, and where in them.
struct Wholes {
  std::vector<int> element;
  std::vector<std::array<TrianglePlace, 3>> corners;
};

Wholes find_wholes(const ElementTable& parts, const FoundLight& direct) {
  Wholes wholes;
  for (int e = 0; e < parts.count(); ++e) {
    const auto triangle = parts.triangle(e);
    const int whole =
        direct.lookup.place(parts.surface[at(e)], (triangle[0] + triangle[1] + triangle[2]) / 3)
            .triangle;
    const auto of_whole = direct.light.elements.triangle(whole);
    wholes.element.push_back(whole);
    auto& corners = wholes.corners.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners[k] = place_of(of_whole, triangle[k]);
  }
  return wholes;
}

/// Direct light on the elements of `extra`, and both together; `total` has those elements.
void add_fields(const AdaptiveField& direct, const std::vector<Region>& region,
                const AdaptiveField& extra, const Wholes& wholes, TotalField& total) {
  const ElementField& light = direct.field;
  std::vector<int> direct_order, order;
  for (int e = 0; e < extra.field.count(); ++e) {
    direct_order.push_back(light.order[at(wholes.element[at(e)])]);
    order.push_back(std::max(extra.field.order[at(e)], direct_order.back()));
  }
  total.direct = zero_field(direct_order);
  total.irradiance = zero_field(std::move(order));
  total.error.resize(extra.field.count());
  for (int e = 0; e < extra.field.count(); ++e) {
    const int whole = wholes.element[at(e)];
    total.direct.of(e) =
        (restriction(direct_order[at(e)], wholes.corners[at(e)]) * light.of(whole).matrix())
            .array();
    add(total.direct.of(e), total.irradiance.of(e));
    add(extra.field.of(e), total.irradiance.of(e));
    total.error[e] = std::hypot(direct.error[whole], extra.error[e]);
    if (!region.empty()) total.region.push_back(region[at(whole)]);
  }
}

/// Of the error on the elements and that of reflected light, relative to the light.
double joint_error(const TotalField& total, double of_reflected) {
  // Squares of light of any size must not over- or underflow.
  const double scale = balancing_scale(total.irradiance.coefficients.abs().maxCoeff());
  double square_error = 0, square = 0;
  for (int e = 0; e < total.elements.count(); ++e) {
    const double area = total.elements.area[at(e)];
    square_error += area * std::pow(scale * total.error[e], 2);
    square += area * (scale * total.irradiance.of(e).matrix()).squaredNorm();
  }
  // What is not a number must not pass for none.
  return square == 0 ? 0 : std::sqrt(square_error / square + of_reflected * of_reflected);
}

}  // namespace

TotalField add_reflected_light(const SoundScene& scene, DirectField direct,
                               const TotalFieldOptions& options, const Progress& progress,
                               Stages& stages) {
  // Reflected light keeps it.
  const auto found = std::make_shared<const FoundLight>(std::move(direct.light));
  const AdaptiveField& light = found->light;
  TotalField total;
  stages.run("reflected light", [&] {
    total.reflected = reflected_light(
        scene, [found](int surface, const Vec3& p) { return found->lookup(surface, p); },
        options.reflected, progress);
    return static_cast<std::size_t>(total.reflected->report().elements);
  });
  const ReflectedReport& report = total.reflected->report();
  const double area = std::accumulate(light.elements.area.begin(), light.elements.area.end(), 0.);
  const double norm = std::sqrt(report.mean_square_total * area);

  AdaptiveField on_elements;
  stages.run("values of reflected light", [&] {
    AdaptiveFieldOptions fit = options.values;
    fit.norm = std::isfinite(norm) ? norm : 0;
    // Quick, and without it nothing found so far would be told: an interrupt has to wait.
    on_elements = fit_adaptively(*direct.patches, values_of(*total.reflected), fit,
                                 {{}, progress.report}, middles_of(*total.reflected));
    return on_elements.elements.corners.size();
  });
  bool gathers = options.final_gather == FinalGather::on;
  if (options.final_gather == FinalGather::automatic && would_help(report)) {
    const double share = share_of_gather(report, on_elements.field, options.reflected.tolerance);
    gathers = share <= most_of_solution;
    stages.leave_out_if(!gathers, "final gather",
                        fmt::format("it takes some {:.2g} times as long as the solution", share));
  }
  if (gathers)
    stages.run("final gather", [&] {
      ElementField field =
          gathered(*total.reflected, on_elements, options.reflected.tolerance, progress);
      if (!progress.stopped()) on_elements.field = std::move(field);
      return on_elements.elements.corners.size();
    });

  total.values = on_elements.report;
  total.elements = std::move(on_elements.elements);
  if (options.reflected.each_bounce)
    total.bounces = told_apart(*total.reflected, total.elements, on_elements.field);
  add_fields(light, direct.region, on_elements, find_wholes(total.elements, *found), total);
  if (options.reflected.through_operator) {
    if (total.bounces.empty()) {
      stages.run("direct light", [&] {
        total.direct = direct_by_operator(scene, total.elements, *total.reflected,
                                          options.reflected, progress);
        return total.elements.corners.size();
      });
    } else {
      total.direct = std::move(total.bounces.front());
      total.bounces.erase(total.bounces.begin());
    }
  }
  total.relative_error = joint_error(total, report.error);
  return total;
}

}  // namespace halfshade
