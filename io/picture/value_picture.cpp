#include "io/picture/value_picture.h"

#include "io/picture/curve_overlay.h"
#include "io/picture/legend.h"
#include "io/picture/mesh_line.h"
#include "io/picture/seen_mesh.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

using detail::Legend, detail::SeenMesh;

/// Where a quantity cannot be told.
const Rgb unknown = Rgb::Constant(0.05);
/// Two results have a surface at the same place if rays to it are as long, relative to it.
constexpr double same_length = 1e-4;
/// Rays that pass a border on either side may differ.
constexpr double most_stray_rays = 0.01;
/// The scenes' areas must be the same to this share.
constexpr double same_area = 1e-4;

void check_values(const ValuePictureOptions& how) {
  if (!how.range) return;
  const auto [low, high] = *how.range;
  if (!(std::isfinite(low) && std::isfinite(high) && low < high) ||
      (how.scale == ValueScale::log && !(low > 0)))
    throw Error(ErrorCode::contract, "draw_values",
                fmt::format("a range from {} to {}; it must not be empty, and on a logarithmic "
                            "scale above zero",
                            low, high));
}

/// What rays on a grid over the picture see.
struct Survey {
  std::vector<double> values;  ///< of emitters only if nothing else has any but zero
  bool below(double low) const {
    return std::any_of(values.begin(), values.end(), [low](double v) { return v < low; });
  }
  bool above(double high) const {
    return std::any_of(values.begin(), values.end(), [high](double v) { return v > high; });
  }
};

Survey survey_values(const SeenMesh& seen, bool is_whole) {
  Survey others, all;
  for (const Vec3& ray : survey(seen.view())) {
    const auto hit = seen.cast(ray);
    if (!hit) continue;
    const double value = seen.value(*hit)[0];
    all.values.push_back(value);
    if (!seen.emits(*hit)) others.values.push_back(value);
  }
  const bool is_dark = std::all_of(others.values.begin(), others.values.end(),
                                   [](double value) { return value == 0; });
  return is_whole || is_dark ? all : others;
}

Legend legend_of(const Quantity& quantity, bool is_difference) {
  Legend legend;
  legend.title.push_back((is_difference ? "difference of " : "") + quantity.name);
  if (!quantity.channel.empty()) legend.title.push_back(quantity.channel);
  if (!quantity.unit.empty()) legend.title.push_back(quantity.unit);
  legend.is_whole = quantity.is_whole && !is_difference;
  legend.is_region = quantity.name.starts_with("region");
  legend.map = is_difference ? ColourMap::diverging : ColourMap::sequential;
  return legend;
}

/// The value that a ray sees; NaN if it cannot be told, nothing if it sees nothing.
using SeenValue = std::function<std::optional<double>(const Vec3& ray, const std::optional<Hit>&)>;

/// Pixels, lines and legend.
Picture paint_values(const SeenMesh& seen, const SeenValue& value, const Legend& legend,
                     const PictureOptions& options, const Progress& progress) {
  const ColourTable colours(legend.map);
  const auto colour = [&](double v) -> Rgb {
    const double share = share_in(legend.range, legend.scale, v);
    return std::isnan(share) ? unknown : colours.at(share);
  };
  const auto sample = [&](const Vec3& ray) -> Rgb {
    const auto hit = seen.cast(ray);
    const std::optional<double> v = value(ray, hit);
    if (!v) return detail::background;
    const Rgb result = colour(*v);
    if (!hit || !options.mesh_lines || !seen.is_on_border(*hit, ray)) return result;
    return detail::with_mesh_line(result, colour(seen.triangle_value(*hit)[0]));
  };
  const int width = options.width + detail::legend_width(legend, options.height);
  detail::LineCanvas canvas(width, options.height, Rgb::Zero());
  const auto look = [&](std::size_t pixel, std::span<const Vec3> rays) {
    Rgb sum = Rgb::Zero();
    for (const Vec3& ray : rays) sum += sample(ray);
    const std::size_t row = pixel / at(options.width);
    canvas.set(row * at(width) + pixel % at(options.width), sum / static_cast<double>(rays.size()));
  };
  if (for_each_pixel(seen.view(), options.samples, look, progress))
    detail::overlay(canvas, options.curves, seen, options.curve_width);
  detail::draw_legend(canvas, options.width, legend);
  return {width, options.height, 0, canvas.bytes(), {}};
}

double area_of(const ShadedMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.points[at(t[0])];
    area += (mesh.points[at(t[1])] - a).cross(mesh.points[at(t[2])] - a).norm() / 2;
  }
  return area;
}

[[noreturn]] void refuse_geometry(const std::string& why) {
  throw Error(ErrorCode::invalid_input, {},
              "only results of the same scene can be compared: " + why);
}

void require_same_area(const ShadedMesh& one, const ShadedMesh& other) {
  const double a = area_of(one), b = area_of(other);
  if (!(std::abs(a - b) <= same_area * std::max(a, b)))
    refuse_geometry(
        fmt::format("the surfaces of the one are {:.6g} large, of the other {:.6g}", a, b));
}

/// One minus the other where a ray ends on both; NaN where they end at different places.
std::optional<double> difference(const SeenMesh& one, const SeenMesh& other, const Vec3& ray,
                                 const std::optional<Hit>& a) {
  const auto b = other.cast(ray);
  if (!a && !b) return std::nullopt;
  if (!a || !b || std::abs(a->distance - b->distance) > same_length * a->distance)
    return std::numeric_limits<double>::quiet_NaN();
  return one.value(*a)[0] - other.value(*b)[0];
}

/// What a ray sees of both.
struct SeenPair {
  double difference, other;
};

/// What rays on a grid over the picture see; of emitters only if there is nothing else. Throws if
/// more than a few rays end at different places.
std::vector<SeenPair> survey_pairs(const SeenMesh& one, const SeenMesh& other) {
  std::vector<SeenPair> pairs, of_emitters;
  std::size_t stray = 0;
  for (const Vec3& ray : survey(one.view())) {
    const auto hit = one.cast(ray);
    const auto value = difference(one, other, ray, hit);
    if (!value) continue;
    if (std::isnan(*value)) {
      ++stray;
      continue;
    }
    (one.emits(*hit) ? of_emitters : pairs).push_back({*value, one.value(*hit)[0] - *value});
  }
  const std::size_t all = pairs.size() + of_emitters.size() + stray;
  if (static_cast<double>(stray) > most_stray_rays * static_cast<double>(all))
    refuse_geometry(
        fmt::format("at {} of the {} places looked at, they have surfaces elsewhere", stray, all));
  return pairs.empty() ? of_emitters : pairs;
}

SeenDifference summary(const std::vector<SeenPair>& pairs) {
  SeenDifference result;
  if (pairs.empty()) return result;
  double squares = 0, reference = 0, sum = 0;
  for (const SeenPair& pair : pairs) {
    result.largest = std::max(result.largest, std::abs(pair.difference));
    squares += pair.difference * pair.difference;
    reference += pair.other * pair.other;
    sum += pair.difference;
  }
  result.rms = std::sqrt(squares / static_cast<double>(pairs.size()));
  result.mean = sum / static_cast<double>(pairs.size());
  if (reference > 0) result.relative = std::sqrt(squares / reference);
  return result;
}

}  // namespace

ValueRange seen_range(const ValueMesh& values, const Camera& camera, const PictureOptions& options,
                      ValueScale scale) {
  const SeenMesh seen(values.mesh, detail::make_view(camera, options), options.shading);
  const bool is_whole = values.quantity.is_whole;
  return robust_range(survey_values(seen, is_whole).values, scale, is_whole);
}

ValuePicture draw_values(const ValueMesh& values, const Camera& camera,
                         const PictureOptions& options, const ValuePictureOptions& how,
                         const Progress& progress) {
  check_values(how);
  const SeenMesh seen(values.mesh, detail::make_view(camera, options), options.shading);
  const bool is_whole = values.quantity.is_whole;
  const Survey survey = survey_values(seen, is_whole);
  Legend legend = legend_of(values.quantity, false);
  legend.scale = how.scale;
  legend.range = how.range ? *how.range : robust_range(survey.values, how.scale, is_whole);
  legend.below = survey.below(legend.range.low);
  legend.above = survey.above(legend.range.high);
  const SeenValue value = [&](const Vec3&, const std::optional<Hit>& hit) {
    return hit ? std::optional(seen.value(*hit)[0]) : std::nullopt;
  };
  return {paint_values(seen, value, legend, options, progress), legend.range, {}};
}

ValuePicture draw_difference(const ValueMesh& one, const ValueMesh& other, const Camera& camera,
                             const PictureOptions& options, const ValuePictureOptions& how,
                             const Progress& progress) {
  check_values(how);
  if (how.scale == ValueScale::log)
    throw Error(ErrorCode::contract, "draw_difference", "differences have no logarithmic scale");
  require_same_area(one.mesh, other.mesh);
  const detail::View view = detail::make_view(camera, options);
  const SeenMesh seen(one.mesh, view, options.shading), beside(other.mesh, view, options.shading);
  const std::vector<SeenPair> pairs = survey_pairs(seen, beside);
  Survey surveyed;
  for (const SeenPair& pair : pairs) surveyed.values.push_back(pair.difference);
  Legend legend = legend_of(one.quantity, true);
  legend.range = how.range ? *how.range : robust_difference_range(surveyed.values);
  legend.below = surveyed.below(legend.range.low);
  legend.above = surveyed.above(legend.range.high);
  const SeenValue value = [&](const Vec3& ray, const std::optional<Hit>& hit) {
    return difference(seen, beside, ray, hit);
  };
  return {paint_values(seen, value, legend, options, progress), legend.range, summary(pairs)};
}

}  // namespace halfshade
