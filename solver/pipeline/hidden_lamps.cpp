#include "solver/pipeline/hidden_lamps.h"

#include "meshing/core/light_source.h"
#include "meshing/core/planar.h"
#include "meshing/triangulation/ring_triangles.h"
#include "solver/pipeline/first_few.h"
#include "solver/pipeline/surface_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// Of an emitter's size: how far before it a face counts as close. And how much of it has to be
/// hidden.
constexpr double close_before = 1e-3, least_hidden = 0.01;
/// Normals of two that look the same way differ by less.
constexpr double same_way = 1e-2;
/// Places along each edge of an emitter's triangles, and in all of one.
constexpr int across = 6, in_triangle = across * (across + 1) / 2;

/// Places that are spread evenly over a surface, with the area each stands for.
std::vector<std::pair<Vec3, double>> spread_places(const Surface& surface) {
  std::vector<Vec2> corners;
  for (const Ring& ring : surface.rings) corners.insert(corners.end(), ring.begin(), ring.end());
  std::vector<std::pair<Vec3, double>> places;
  for (const auto& [i, j, k] : ring_triangles(surface.rings)) {
    const Vec2 &a = corners[at(i)], &b = corners[at(j)], &c = corners[at(k)];
    const double area = 0.5 * cross_2d(b - a, c - a) / in_triangle;
    for (int u = 0; u < across; ++u)
      for (int v = 0; u + v < across; ++v)
        places.emplace_back(
            surface.frame.to_space(a + ((u + 1. / 3) * (b - a) + (v + 1. / 3) * (c - a)) / across),
            area);
  }
  return places;
}

}  // namespace

std::string hidden_lamps(const SoundScene& scene) {
  std::vector<Bounds> boxes;
  for (const Surface& surface : scene.surfaces) boxes.push_back(outline_bounds(surface));
  const FlatTree tree = make_flat_tree(boxes);
  const auto has_back = [&](int s, const Bounds& box) {
    bool found = false;
    visit_overlaps(tree, box, [&](int t) {
      found =
          found || (scene.surfaces[at(t)].plane == scene.surfaces[at(s)].plane &&
                    scene.surfaces[at(t)].frame.normal.dot(scene.surfaces[at(s)].frame.normal) < 0);
    });
    return found;
  };
  std::vector<std::string> lamps;
  double share = 0;
  for (const LightSource& source : light_sources(scene)) {
    const Surface& lamp = scene.surfaces[at(source.surface)];
    const double reach = close_before * size_of(lamp);
    const Bounds box = boxes[at(source.surface)].grown(reach);
    std::vector<int> before;
    visit_overlaps(tree, box, [&](int s) {
      const Surface& other = scene.surfaces[at(s)];
      if (s != source.surface && (other.frame.normal - lamp.frame.normal).norm() < same_way &&
          !has_back(s, box))
        before.push_back(s);
    });
    if (before.empty()) continue;
    double hidden = 0;
    for (const auto& [p, part] : spread_places(lamp))
      if (std::any_of(before.begin(), before.end(), [&, &p = p](int s) {
            const Surface& other = scene.surfaces[at(s)];
            const double height = other.frame.height(p);
            return height < 0 && height > -reach && is_inside(other.rings, other.frame.to_plane(p));
          }))
        hidden += part;
    if (hidden < least_hidden * area(lamp)) continue;
    share = std::max(share, hidden / area(lamp));
    const std::string name =
        fmt::format("{} ({})", lamp.faces.front() + 1, scene.groups[at(lamp.group)]);
    if (std::find(lamps.begin(), lamps.end(), name) == lamps.end()) lamps.push_back(name);
  }
  if (lamps.empty()) return {};
  const bool is_one = lamps.size() == 1;
  return fmt::format(
      "face{} {} emit{} light onto the back of a face that looks the same way and lies close "
      "before, "
      "which hides {:.0f} % of {}: to be flush with it, {} to be moved before it, or coordinates "
      "to be "
      "written with more digits",
      is_one ? "" : "s", first_few(lamps), is_one ? "s" : "", 100 * share,
      is_one ? "it" : "one of them", is_one ? "it has" : "they have");
}

}  // namespace halfshade
