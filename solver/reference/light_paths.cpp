#include "solver/reference/light_paths.h"

#include "meshing/core/error.h"
#include "meshing/geometry/cosine_direction.h"

#include <numbers>

namespace halfshade {
namespace {

/// Reflections before roulette begins: the first ones carry most of the light.
constexpr int sure_bounces = 2;

/// Where all but 1e-5 of the light is reflected, one path in e^10 is longer.
constexpr int longest_path = 1000000;

/// Numbers of a sample that a bounce uses.
enum Use : std::uint32_t { way_ahead, place_on_emitter, roulette, uses };

std::uint32_t use_of(int bounce, Use use) {
  return static_cast<std::uint32_t>(bounce) * uses + use;
}

/// Goes on with a probability that keeps the weight of what goes on at 1 in its largest channel.
bool survives(double number, Rgb& weight) {
  const double chance = std::min(1., weight.maxCoeff());
  if (number >= chance) return false;
  weight /= chance;
  return true;
}

}  // namespace

/// Where a path meets a surface.
struct LightPaths::End {
  Vec3 position;
  Vec3 normal;
  int surface = -1;  ///< −1: none, the path begins there
  double distance = 0;
};

LightPaths::LightPaths(const SoundScene& scene)
    : scene_(scene), visibility_(surface_triangles(scene)), emitters_(scene, visibility_.soup()) {}

const Material& LightPaths::material(const End& end) const {
  return scene_.materials[at(scene_.surfaces[at(end.surface)].material)];
}

/// The first front ahead; nothing if the ray leaves the scene or meets a back, which is black. Of
/// two surfaces back to back it meets the one that faces it.
std::optional<LightPaths::End> LightPaths::next_end(const End& from, const Vec3& direction) const {
  std::optional<Hit> hit = visibility_.first_hit(from.position, direction);
  if (!hit) return std::nullopt;
  if (scene_.surfaces[at(hit->owner)].frame.normal.dot(direction) >= 0) {
    hit = visibility_.facing_hit({from.position, direction}, *hit);
    if (!hit) return std::nullopt;
  }
  const PlaneFrame& frame = scene_.surfaces[at(hit->owner)].frame;
  const Vec3 met = from.position + hit->distance * direction;
  return End{met - frame.height(met) * frame.normal, frame.normal, hit->owner, hit->distance};
}

std::optional<SeenPlace> LightPaths::seen(const Vec3& origin, const Vec3& direction) const {
  const auto hit = visibility_.first_hit(origin, direction, Sides::front_only);
  if (!hit) return std::nullopt;
  const PlaneFrame& frame = scene_.surfaces[at(hit->owner)].frame;
  const Vec3 met = origin + hit->distance * direction;
  return SeenPlace{{met - frame.height(met) * frame.normal, frame.normal}, hit->owner};
}

/// Light straight from a random point of the emitters.
Rgb LightPaths::from_emitters(const End& to, int bounce, const SampleNumbers& numbers) const {
  const auto sample = emitters_.point(numbers.pair(use_of(bounce, place_on_emitter)));
  if (!sample) return Rgb::Zero();
  const Surface& emitter = scene_.surfaces[at(sample->surface)];
  const Vec3 way = sample->position - to.position;
  const double r = way.norm();
  const double here = to.normal.dot(way), there = -emitter.frame.normal.dot(way);
  if (!(here > 0 && there > 0)) return Rgb::Zero();
  const int plane = to.surface < 0 ? -1 : scene_.surfaces[at(to.surface)].plane;
  if (visibility_.blocked(Segment{to.position, sample->position, plane, emitter.plane}))
    return Rgb::Zero();
  // Probabilities per area of the emitter: of this sample, and of a ray ahead.
  const double ahead = (here / r) * (there / r) / (std::numbers::pi * r * r);
  return scene_.materials[at(emitter.material)].exitance * (ahead / (ahead + sample->density));
}

/// Light straight from where the ray ahead ends.
Rgb LightPaths::from_ahead(const End& to, const End& from, const Vec3& direction) const {
  const Rgb& exitance = material(from).exitance;
  if ((exitance == 0).all()) return Rgb::Zero();
  const double cosines = to.normal.dot(direction) * -from.normal.dot(direction);
  const double ahead = cosines / (std::numbers::pi * from.distance * from.distance);
  return exitance * (ahead / (ahead + emitters_.density(from.surface)));
}

ArrivingLight LightPaths::trace(const ReferencePoint& point, int bounces,
                                const SampleNumbers& numbers) const {
  ArrivingLight light;
  Rgb weight = Rgb::Ones();
  End here{point.position, point.normal};
  for (int bounce = 0; bounce < longest_path; ++bounce) {
    Rgb& sum = bounce == 0 ? light.direct : light.reflected;
    sum += weight * from_emitters(here, bounce, numbers);
    const Vec2 turned = numbers.pair(use_of(bounce, way_ahead));
    const Vec3 way =
        cosine_direction(make_frame(Vec3::Zero(), here.normal), turned.x(), turned.y());
    const std::optional<End> next = next_end(here, way);
    if (next) sum += weight * from_ahead(here, *next, way);
    if (next) weight *= reflectance_at(scene_, scene_.surfaces[at(next->surface)], next->position);
    const bool last = !next || bounce == bounces || (weight == 0).all();
    if (last ||
        (bounce >= sure_bounces && !survives(numbers.number(use_of(bounce, roulette)), weight))) {
      light.total = light.direct + light.reflected;
      return light;
    }
    here = *next;
  }
  throw Error(ErrorCode::invalid_input, {},
              "light in a closed space is hardly ever absorbed, so paths do not end; lower a "
              "reflectance");
}

}  // namespace halfshade
