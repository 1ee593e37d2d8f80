#include "solver/pipeline/saved_light.h"

#include "meshing/core/error.h"
#include "meshing/core/planar.h"
#include "solver/pipeline/field_lookup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace halfshade {
namespace {

/// How far elements may be off their surface, as a share of its size, and their areas' sum of its
/// area: files of scenes have six digits.
constexpr double off_by_rounding = 1e-5;

/// Numbers that went through a file.
bool are_same(const Rgb& a, const Rgb& b) {
  constexpr double rounding = 1e-9;
  return ((a - b).abs() <= rounding * b.abs()).all();
}

/// Normals of elements that lie in the scene's surfaces.
std::vector<Vec3> normals_in(const SoundScene& scene, const SavedLight& light) {
  std::vector<Vec3> normals;
  const auto refuse = [&light](const std::string& why) {
    throw Error(ErrorCode::invalid_input, light.source,
                fmt::format("this is no solution of the scene: {}", why));
  };
  const ElementTable& elements = light.elements;
  const int count = static_cast<int>(scene.surfaces.size());
  std::vector<double> covered(scene.surfaces.size(), 0);
  for (int e = 0; e < elements.count(); ++e) {
    const int s = elements.surface[at(e)];
    if (s < 0 || s >= count)
      refuse(fmt::format("element {} is of surface {}, and there are {}", e, s, count));
    const Surface& surface = scene.surfaces[at(s)];
    const auto [a, b, c] = elements.triangle(e);
    for (const Vec3& p : {a, b, c})
      if (std::abs(surface.frame.height(p)) > off_by_rounding * size_of(surface))
        refuse(fmt::format("element {} is not in the plane of surface {}", e, s));
    const Material& material = scene.materials[at(surface.material)];
    // What painted ones reflect differs from element to element.
    if (!are_same(light.exitance[at(e)], material.exitance) ||
        (surface.paint < 0 && !are_same(light.rho[at(e)], material.rho)))
      refuse(
          fmt::format("element {} is not of the material '{}' of surface {}", e, material.name, s));
    normals.push_back(surface.frame.normal);
    covered[at(s)] += (b - a).cross(c - a).dot(surface.frame.normal) / 2;
  }
  for (int s = 0; s < count; ++s)
    if (const double all = area(scene.surfaces[at(s)]);
        std::abs(covered[at(s)] - all) > off_by_rounding * all)
      refuse(fmt::format("elements of surface {} have an area of {} instead of {}", s,
                         covered[at(s)], all));
  return normals;
}

struct Kept {
  explicit Kept(SavedLight saved)
      : light(std::move(saved)), lookup(light.elements, light.irradiance) {}

  SavedLight light;
  FieldLookup lookup;
};

}  // namespace

ReflectedLight reflection_of(const SoundScene& scene, SavedLight light, const Progress& progress) {
  light.elements.normal = normals_in(scene, light);
  const auto kept = std::make_shared<const Kept>(std::move(light));
  ReflectedOptions options;
  // Nothing is solved for: gather() brings what is reflected once of the light that is given.
  options.bounces = 0;
  options.visibility = ReflectedVisibility::sampled;
  return reflected_light(
      scene, [kept](int surface, const Vec3& p) { return kept->lookup(surface, p); }, options,
      progress);
}

}  // namespace halfshade
