#include "solver/pipeline/goal.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

/// Adds a field's power on a group.
void add_power(int group, const ElementTable& elements, const ElementField& field, Rgb& power) {
  for (int e = 0; e < elements.count(); ++e)
    if (elements.group[at(e)] == group)
      power += elements.area[at(e)] * field.of(e).row(0).transpose();
}

}  // namespace

double area_of_group(const SoundScene& scene, int group) {
  double sum = 0;
  for (const Surface& surface : scene.surfaces)
    if (surface.group == group) sum += area(surface);
  return sum;
}

int find_goal(const SoundScene& scene, std::string_view name) {
  const auto found = std::find(scene.groups.begin(), scene.groups.end(), name);
  const int group = static_cast<int>(found - scene.groups.begin());
  if (found == scene.groups.end())
    throw Error(ErrorCode::usage, {},
                fmt::format("--goal: there is no group '{}'; the scene has {}", name,
                            fmt::join(scene.groups, ", ")));
  if (!(area_of_group(scene, group) > 0))
    throw Error(ErrorCode::usage, {},
                fmt::format("--goal: no surface is left of the group '{}'", name));
  return group;
}

GoalResult goal_mean(int group, const ElementTable& elements, const ElementField& direct,
                     const ReflectedLight* reflected) {
  GoalResult result;
  result.group = group;
  for (int e = 0; e < elements.count(); ++e)
    if (elements.group[at(e)] == group) result.area += elements.area[at(e)];
  Rgb power = Rgb::Zero();
  // Light that went the way of reflected light is all in it.
  if (!reflected || !reflected->report().through_operator)
    add_power(group, elements, direct, power);
  result.unknowns = at(direct.first.back());
  if (reflected) {
    add_power(group, reflected->elements(), reflected->field(), power);
    result.unknowns += at(reflected->field().first.back());
  }
  result.mean = power / result.area;
  return result;
}

}  // namespace halfshade
