#include "solver/factors/joined_scene.h"

#include "meshing/repair/coplanar.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

namespace halfshade {
namespace {

/// Joined surfaces must be as large as their parts together, relative to that.
constexpr double as_large = 1e-9;

auto key_of(const Vec3& v) { return std::tuple(v.x(), v.y(), v.z()); }

/// Surfaces of one plane that look the same way, in one frame.
using Side = std::vector<int>;

/// Only what shares a frame to the bit shares the coordinates of its corners.
std::vector<Side> sides_of(const SoundScene& scene) {
  using Key = std::tuple<double, double, double>;
  std::map<std::tuple<int, bool, Key, Key, Key>, Side> sides;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    if (surface.rings.size() > 1) continue;
    const PlaneFrame& frame = surface.frame;
    sides[{surface.plane, surface.back, key_of(frame.origin), key_of(frame.e1), key_of(frame.e2)}]
        .push_back(static_cast<int>(s));
  }
  std::vector<Side> result;
  for (auto& [key, side] : sides)
    if (side.size() > 1) result.push_back(std::move(side));
  return result;
}

/// Corners of several surfaces in one frame, the same ones only once.
class Corners {
 public:
  explicit Corners(const PlaneFrame& frame) : frame_(frame) {}

  std::vector<int> ids(const Ring& ring) {
    std::vector<int> result;
    for (const Vec2& p : ring) {
      const auto [entry, is_new] =
          ids_.emplace(std::pair(p.x(), p.y()), static_cast<int>(flat_.size()));
      if (is_new) {
        flat_.push_back(p);
        points.push_back(frame_.to_space(p));
      }
      result.push_back(entry->second);
    }
    return result;
  }

  Ring ring(const std::vector<int>& loop) const {
    Ring result;
    for (const int id : loop)
      result.push_back(at(id) < flat_.size() ? flat_[at(id)] : frame_.to_plane(points[at(id)]));
    return result;
  }

  std::vector<Vec3> points;  ///< those that joining adds come last

 private:
  PlaneFrame frame_;
  std::map<std::pair<double, double>, int> ids_;
  std::vector<Vec2> flat_;
};

struct Joined {
  Surface surface;
  std::vector<int> parts;
};

/// Nothing if the parts would not be what they were.
std::optional<std::vector<Joined>> joined(const SoundScene& scene, const Side& side) {
  const Surface& first = scene.surfaces[at(side.front())];
  Corners corners(first.frame);
  std::vector<CoplanarFace> faces;
  for (const int s : side) {
    const Surface& surface = scene.surfaces[at(s)];
    CoplanarFace face;
    face.face = s;
    face.area = area(surface);
    face.scale = surface.scale;
    face.loop = corners.ids(surface.rings.front());
    faces.push_back(std::move(face));
  }
  const CoplanarResult found = resolve_coplanar(corners.points, first.frame, faces);
  if (!found.crossed.empty()) return std::nullopt;
  std::vector<Joined> result;
  std::size_t parts = 0;
  for (const SurfaceDraft& draft : found.drafts) {
    Joined one{first, draft.faces};
    one.surface.rings.clear();
    one.surface.contacts.clear();
    one.surface.face_rings.clear();
    one.surface.faces.clear();
    one.surface.scale = draft.scale;
    for (const auto& loop : draft.rings) one.surface.rings.push_back(corners.ring(loop));
    std::sort(one.parts.begin(), one.parts.end());
    const double together =
        std::transform_reduce(one.parts.begin(), one.parts.end(), 0., std::plus<>(),
                              [&](int s) { return area(scene.surfaces[at(s)]); });
    if (!(std::abs(area(one.surface) - together) <= as_large * together)) return std::nullopt;
    parts += one.parts.size();
    result.push_back(std::move(one));
  }
  if (parts != side.size()) return std::nullopt;
  return result;
}

}  // namespace

JoinedScene join_coplanar(const SoundScene& scene) {
  std::vector<Joined> all;
  std::vector<bool> is_joined(scene.surfaces.size(), false);
  for (const Side& side : sides_of(scene))
    if (auto found = joined(scene, side)) {
      for (const int s : side) is_joined[at(s)] = true;
      for (Joined& one : *found)
        all.push_back(one.parts.size() > 1
                          ? std::move(one)
                          : Joined{scene.surfaces[at(one.parts.front())], one.parts});
    }
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
    if (!is_joined[s]) all.push_back({scene.surfaces[s], {static_cast<int>(s)}});
  std::sort(all.begin(), all.end(),
            [](const Joined& a, const Joined& b) { return a.parts.front() < b.parts.front(); });
  JoinedScene result;
  result.sound.materials = scene.materials;
  result.sound.groups = scene.groups;
  result.sound.diagonal = scene.diagonal;
  result.of.resize(scene.surfaces.size());
  for (Joined& one : all) {
    for (const int s : one.parts) result.of[at(s)] = static_cast<int>(result.parts.size());
    result.sound.surfaces.push_back(std::move(one.surface));
    result.parts.push_back(std::move(one.parts));
  }
  return result;
}

}  // namespace halfshade
