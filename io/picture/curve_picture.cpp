#include "io/picture/curve_picture.h"

#include "io/picture/line_canvas.h"
#include "meshing/core/error.h"
#include "meshing/core/planar.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace halfshade {
namespace {

// Directions this nearly alike are alike: the first is taken.
constexpr double least_better = 1e-6;

using Bytes = std::array<std::uint8_t, 3>;

constexpr Bytes red = {235, 60, 50}, blue = {70, 130, 255}, pink = {255, 105, 190},
                yellow = {250, 215, 50}, green = {80, 200, 110}, teal = {60, 200, 215};
constexpr Bytes page = {24, 24, 27}, outline = {150, 150, 155};
/// Light is drawn between these greys, so that curves of any colour stand out.
constexpr double darkest = 40, brightest = 205;
/// An axis this nearly along the normal (its cosine above 0.87) shows no up.
constexpr double least_upright = 0.5;
/// The share of pixels, in percent, that are not saturated.
constexpr std::size_t white_percentile = 99;
/// Empty border round the surfaces, as a share of their size.
constexpr double margin = 0.02;

/// Where a plane lies in the picture.
struct Map {
  Vec3 corner;       ///< of the first pixel
  Vec3 right, down;  ///< one pixel
  int width, height;

  Vec3 to_space(double x, double y) const { return corner + x * right + y * down; }
  Vec2 to_picture(const Vec3& p) const {
    return {right.dot(p - corner) / right.squaredNorm(), down.dot(p - corner) / down.squaredNorm()};
  }
};

/// The axis of the world nearest to what the user calls up; y, or z where y is the normal.
Vec3 upwards(const Vec3& normal, const Vec3& up) {
  const Vec3 flat = up - up.dot(normal) * normal;
  Vec3 best = Vec3::Zero();
  for (const int axis : {1, 2, 0})
    for (const double sign : {1., -1.}) {
      const Vec3 candidate = sign * Vec3::Unit(axis);
      const Vec3 projected = candidate - candidate.dot(normal) * normal;
      if (projected.norm() < least_upright) continue;
      if (best.isZero() || flat.dot(projected) > flat.dot(best) + least_better) best = projected;
    }
  return best.normalized();
}

Map make_map(const SoundScene& scene, std::span<const int> surfaces,
             const CurvePictureOptions& options) {
  const Vec3 normal = scene.surfaces[at(surfaces.front())].frame.normal;
  const Vec3 up = upwards(normal, options.up), right = up.cross(normal);
  Eigen::AlignedBox2d box;
  const Vec3 origin = scene.surfaces[at(surfaces.front())].frame.origin;
  for (const int r : surfaces)
    for (const Vec2& q : scene.surfaces[at(r)].rings.front()) {
      const Vec3 p = scene.surfaces[at(r)].frame.to_space(q) - origin;
      box.extend(Vec2(right.dot(p), up.dot(p)));
    }
  const double size = box.sizes().maxCoeff() * (1 + 2 * margin), pixel = size / options.pixels;
  const Vec2 extent = box.sizes().array() + 2 * margin * box.sizes().maxCoeff();
  const auto pixels = [&](double length) {
    return std::clamp(static_cast<int>(std::lround(length / pixel)), 1, options.pixels);
  };
  Map map;
  map.width = pixels(extent.x());
  map.height = pixels(extent.y());
  map.right = pixel * right;
  map.down = -pixel * up;
  map.corner = origin + box.center().x() * right + box.center().y() * up -
               map.width / 2. * map.right - map.height / 2. * map.down;
  return map;
}

/// Paints the exact direct light at pixel centres; returns the exposure.
double paint_light(const SoundScene& scene, const DirectLightIndex& index,
                   std::span<const int> surfaces, const Map& map, const Progress& progress,
                   detail::LineCanvas& canvas) {
  std::vector<std::size_t> pixels;
  std::vector<SurfacePoint> points;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const Vec3 p = map.to_space(x + 0.5, y + 0.5);
      for (const int r : surfaces) {
        const Surface& surface = scene.surfaces[at(r)];
        const Vec2 q = surface.frame.to_plane(p);
        if (!is_inside(surface.rings, q)) continue;
        pixels.push_back(at(y) * at(map.width) + at(x));
        points.push_back({surface.frame.to_space(q), surface.frame.normal});
        break;
      }
    }
  const std::vector<DirectLight> light = index.irradiance(points, progress);
  std::vector<double> values;
  for (const DirectLight& value : light) values.push_back(value.irradiance.mean());
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double white = sorted.empty() ? 0 : sorted[(sorted.size() - 1) * white_percentile / 100];
  const double exposure = white > 0 ? 1 / white : 1;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    // A root, as the eye judges brightness.
    const double shade = std::sqrt(std::min(1., exposure * values[k]));
    const auto grey =
        static_cast<std::uint8_t>(std::lround(darkest + (brightest - darkest) * shade));
    canvas.set(pixels[k], detail::decode_srgb({grey, grey, grey}));
  }
  return exposure;
}

void draw_outlines(const SoundScene& scene, std::span<const int> surfaces, const Map& map,
                   detail::LineCanvas& canvas) {
  for (const int r : surfaces)
    for (const Ring& ring : scene.surfaces[at(r)].rings) {
      std::vector<Vec2> points;
      for (std::size_t k = 0; k <= ring.size(); ++k)
        points.push_back(
            map.to_picture(scene.surfaces[at(r)].frame.to_space(ring[k % ring.size()])));
      canvas.line(points, 1, detail::decode_srgb(outline));
    }
}

void check(const SoundScene& scene, std::span<const int> surfaces,
           const CurvePictureOptions& options) {
  const auto fail = [](const std::string& sentence) {
    throw Error(ErrorCode::contract, "draw_curves", sentence);
  };
  if (options.pixels < least_curve_pixels || options.pixels > most_pixels)
    fail(fmt::format("{} pixels; they must be in {} to {}", options.pixels, least_curve_pixels,
                     most_pixels));
  if (!(options.line_width > 0 && std::isfinite(options.line_width)))
    fail(fmt::format("a line width of {}; it must be positive", options.line_width));
  if (surfaces.empty()) fail("there are no surfaces to draw");
  for (const int r : surfaces)
    if (r < 0 || at(r) >= scene.surfaces.size()) fail(fmt::format("there is no surface {}", r));
  const Surface& first = scene.surfaces[at(surfaces.front())];
  for (const int r : surfaces)
    if (const Surface& other = scene.surfaces[at(r)];
        other.plane != first.plane || other.frame.normal.dot(first.frame.normal) < 0)
      fail(fmt::format("surfaces {} and {} do not face one way in one plane", surfaces.front(), r));
}

/// Surfaces of one group that face the same way in the same plane as `surface`.
std::vector<int> neighbours_of(const SoundScene& scene, int surface) {
  const Surface& first = scene.surfaces[at(surface)];
  std::vector<int> result;
  for (int r = 0; r < static_cast<int>(scene.surfaces.size()); ++r) {
    const Surface& other = scene.surfaces[at(r)];
    if (other.plane == first.plane && other.group == first.group &&
        other.frame.normal.dot(first.frame.normal) > 0)
      result.push_back(r);
  }
  return result;
}

}  // namespace

std::array<std::uint8_t, 3> curve_colour(const DiscontinuityCurve& curve, CurveColour by) {
  if (by == CurveColour::order && curve.order < 2) return curve.order == 0 ? red : blue;
  switch (curve.kind) {
    case CurveKind::contact:
      return red;
    case CurveKind::face:
      return by == CurveColour::order ? pink : green;
    case CurveKind::ev:
      return pink;
    case CurveKind::eee:
      return yellow;
    case CurveKind::horizon:
      return teal;
  }
  return red;
}

std::vector<int> picture_surfaces(const SoundScene& scene, const Discontinuities& found,
                                  std::string_view name) {
  if (name.empty()) {
    std::vector<int> curves(scene.surfaces.size(), 0);
    for (const DiscontinuityCurve& curve : found.curves) ++curves[at(curve.receiver)];
    const auto most = std::max_element(curves.begin(), curves.end());
    if (most == curves.end() || *most == 0)
      throw Error(ErrorCode::usage, "picture", "there are no curves to draw; name a surface");
    return neighbours_of(scene, static_cast<int>(most - curves.begin()));
  }
  int first = -1;
  const auto group = std::find(scene.groups.begin(), scene.groups.end(), name);
  if (group != scene.groups.end()) {
    for (int r = 0; r < static_cast<int>(scene.surfaces.size()); ++r)
      if (const Surface& surface = scene.surfaces[at(r)];
          surface.group == static_cast<int>(group - scene.groups.begin()) && !surface.back) {
        if (first < 0) first = r;
        const std::vector<int> same = neighbours_of(scene, first);
        if (std::find(same.begin(), same.end(), r) == same.end())
          throw Error(ErrorCode::usage, "picture",
                      fmt::format("the group '{}' has surfaces in several planes, such as {} and "
                                  "{}; name one by its number",
                                  name, first, r));
      }
  } else {
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), first);
    if (error != std::errc() || end != name.data() + name.size() || first < 0 ||
        at(first) >= scene.surfaces.size())
      first = -1;
  }
  if (first < 0)
    throw Error(ErrorCode::usage, "picture",
                fmt::format("there is no group or surface '{}'; the scene has the groups {} and "
                            "surfaces 0 to {}",
                            name, fmt::join(scene.groups, ", "), scene.surfaces.size() - 1));
  return group != scene.groups.end() ? neighbours_of(scene, first) : std::vector<int>{first};
}

Picture draw_curves(const SoundScene& scene, const DirectLightIndex& light,
                    const Discontinuities& found, std::span<const int> surfaces,
                    const CurvePictureOptions& options, const Progress& progress) {
  check(scene, surfaces, options);
  const Map map = make_map(scene, surfaces, options);
  detail::LineCanvas canvas(map.width, map.height, detail::decode_srgb(page));
  Picture picture;
  picture.width = map.width;
  picture.height = map.height;
  picture.exposure = paint_light(scene, light, surfaces, map, progress, canvas);
  draw_outlines(scene, surfaces, map, canvas);
  std::vector<const DiscontinuityCurve*> curves;
  for (const DiscontinuityCurve& curve : found.curves)
    if (std::find(surfaces.begin(), surfaces.end(), curve.receiver) != surfaces.end())
      curves.push_back(&curve);
  std::stable_sort(curves.begin(), curves.end(), [](const auto* a, const auto* b) {
    return std::pair(a->order, a->kind) > std::pair(b->order, b->kind);
  });
  const double pixel = map.right.norm();
  for (const DiscontinuityCurve* curve : curves) {
    constexpr double smoothness = 0.1;  // pixels
    const Surface& surface = scene.surfaces[at(curve->receiver)];
    std::vector<Vec2> points;
    for (const double s : flatten(curve->arc, smoothness * pixel))
      points.push_back(map.to_picture(surface.frame.to_space(point_at(curve->arc, s))));
    canvas.line(points, options.line_width,
                detail::decode_srgb(curve_colour(*curve, options.colour)));
  }
  picture.pixels = canvas.bytes();
  return picture;
}

}  // namespace halfshade
