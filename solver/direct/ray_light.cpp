#include "solver/direct/ray_light.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/triangulation/ring_triangles.h"
#include "solver/direct/emitter_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

constexpr std::size_t places_of_task = 64;

/// The variance of the visible share is this over the number of rays to the power of 3/2: an edge
/// of a shadow cuts as many of the rays' cells as lie along it. With few rays that is above the 1/4
/// of independent ones. Two halves of them, each spread on its own, do somewhat worse than all.
constexpr double variance_of_rays = 0.7, power_of_rays = 1.5;
/// Of the deviation: light of a part of an emitter that need not be even.
constexpr double negligible = 0.5;
/// Rays that tell what an element sees of an emitter.
constexpr int rays_of_region = 16;
/// Directions that differ by less draw the same random numbers; above the rounding of coordinates.
constexpr double same_direction = 0x1p-24;

/// Evenly over a triangle, for s and t in [0, 1].
Vec3 point_of(const std::array<Vec3, 3>& triangle, double s, double t) {
  const auto& [a, b, c] = triangle;
  return a + std::sqrt(s) * (b - a + t * (c - b));
}

/// An emitter as triangles, to draw points of it.
struct RayEmitter {
  EmitterTarget target;
  int surface = 0, plane = 0;
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<double> reached;  ///< area of all triangles up to each

  double area() const { return reached.back(); }

  Vec3 point(double s, double t) const {
    const double along = s * area();
    const auto first = std::upper_bound(reached.begin(), reached.end() - 1, along);
    const auto k = static_cast<std::size_t>(first - reached.begin());
    const double from = k == 0 ? 0 : reached[k - 1];
    const double rest = std::clamp((along - from) / (reached[k] - from), 0., 1.);
    return point_of(triangles[k], rest, t);
  }
};

RayEmitter make_ray_emitter(const SoundScene& scene, int id) {
  const Surface& surface = scene.surfaces[at(id)];
  RayEmitter emitter;
  emitter.target = make_emitter_target(scene, surface);
  emitter.surface = id;
  emitter.plane = surface.plane;
  std::vector<Vec3> corners;
  for (const auto& ring : emitter.target.rings)
    corners.insert(corners.end(), ring.begin(), ring.end());
  double reached = 0;
  for (const auto& [i, j, k] : ring_triangles(surface.rings)) {
    const std::array<Vec3, 3> triangle = {corners[at(i)], corners[at(j)], corners[at(k)]};
    const double area = 0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
    if (!(area > 0)) continue;
    emitter.triangles.push_back(triangle);
    emitter.reached.push_back(reached += area);
  }
  return emitter;
}

/// Places in a square that fill it evenly, however many are drawn.
class SpreadPairs {
 public:
  explicit SpreadPairs(std::uint64_t seed)
      : s_(unit_share(mix_bits(seed))), t_(unit_share(mix_bits(seed + splitmix_step))) {}
  std::array<double, 2> next() {
    constexpr double root = 1.32471795724474602596;  // of x³ = x + 1
    s_ = step(s_, 1 / root);
    t_ = step(t_, 1 / (root * root));
    return {s_, t_};
  }

 private:
  static double step(double from, double width) {
    const double to = from + width;
    return to < 1 ? to : to - 1;
  }

  double s_, t_;
};

std::uint64_t seed_of(const Vec3& position, const EmitterTarget& target) {
  const Vec3 way = target.centre - position;
  const double size = way.lpNorm<Eigen::Infinity>();
  std::uint64_t bits = 0;
  for (int k = 0; k < 3 && size > 0; ++k)
    bits =
        mix_bits(bits ^ static_cast<std::uint64_t>(std::llround(way[k] / size / same_direction)));
  return bits;
}

/// What rays to one emitter are to tell.
struct Look {
  const RayEmitter* emitter;
  double factor;                             ///< form factor if nothing is in between
  double strength;                           ///< light that gives
  std::size_t first_part = 0, end_part = 0;  ///< in the work's list; none: light from it is even
  bool is_near = false;                      ///< too near to be cut into parts
  int rays = 0;  ///< for one of two estimates; 0: its visible part is looked for
};

/// Rays to a part of an emitter, or to all of it, for one estimate.
struct RayGroup {
  double factor;    ///< form factor if nothing is in between
  std::size_t end;  ///< of its segments
};

/// Buffers of one task.
struct RayWork {
  std::vector<Look> looks;
  std::vector<EmitterPart> parts;
  std::vector<Segment> segments;
  std::vector<double> weights;
  std::vector<RayGroup> groups;
  std::vector<std::size_t> ends;  ///< of the groups of both estimates of each look
  std::vector<std::uint8_t> blocked;
};

}  // namespace

struct RayLight::Impl {
  const SoundScene* scene;
  const DirectLightIndex* exact;
  const VisibilityIndex* visibility;
  RayLightOptions options;
  std::vector<RayEmitter> emitters;

  /// Emitters that a point may see, the one that can give most first.
  void collect_looks(const SurfacePoint& point, std::vector<Look>& looks) const {
    looks.clear();
    for (const RayEmitter& emitter : emitters) {
      const EmitterTarget& target = emitter.target;
      if (is_clearly_away(target, point)) continue;
      const double factor = unobstructed_factor(point.position, point.normal, target.rings);
      if (factor > 0) looks.push_back({&emitter, factor, factor * target.strength});
    }
    std::stable_sort(looks.begin(), looks.end(),
                     [](const Look& a, const Look& b) { return a.strength > b.strength; });
  }

  /// Emitters over which light varies much are looked at part by part.
  void cut_uneven(const SurfacePoint& point, RayWork& work) const {
    work.parts.clear();
    for (Look& look : work.looks) {
      const EmitterTarget& target = look.emitter->target;
      if (is_even(point, target, look.emitter->area(), look.factor)) continue;
      look.first_part = work.parts.size();
      look.is_near = !cut_evenly(point, target, look.emitter->triangles,
                                 negligible * options.deviation / target.strength, work.parts);
      look.end_part = work.parts.size();
    }
  }

  /// The fewest rays in all with which the variances sum to what is allowed.
  void share_rays(std::vector<Look>& looks) const {
    constexpr double power = 2 / (power_of_rays + 1);
    const double variance = options.deviation * options.deviation / variance_of_rays;
    const auto first_by_rays = std::stable_partition(looks.begin(), looks.end(),
                                                     [](const Look& look) { return look.is_near; });
    double sum = 0;
    for (auto look = first_by_rays; look != looks.end(); ++look)
      sum += std::pow(look->strength, power);
    for (auto look = first_by_rays; look != looks.end(); ++look) {
      const double each = std::pow(sum / variance, 1 / power_of_rays);
      const double rays = std::ceil(each * std::pow(look->strength, power));
      if (rays > options.most_rays) {
        sum -= std::pow(look->strength, power);
        continue;
      }
      look->rays = std::max(static_cast<int>(std::ceil(rays / 2)), 1);
    }
  }

  /// Adds the rays of one estimate of a look.
  void add_rays(const FieldPoint& place, const Look& look, std::uint64_t seed,
                RayWork& work) const {
    if (look.rays > 0 && look.first_part == look.end_part)
      add_group(place, *look.emitter, nullptr, look.factor, look.rays, seed, work);
    for (std::size_t p = look.first_part; look.rays > 0 && p < look.end_part; ++p) {
      const EmitterPart& part = work.parts[p];
      const int rays = static_cast<int>(std::ceil(look.rays * part.factor / look.factor));
      seed = mix_bits(seed + splitmix_step);
      add_group(place, *look.emitter, &part.triangle, part.factor, rays, seed, work);
    }
    work.ends.push_back(work.groups.size());
  }

  /// Without those below the point's horizon. `triangle`: all of the emitter if null.
  void add_group(const FieldPoint& place, const RayEmitter& emitter,
                 const std::array<Vec3, 3>* triangle, double factor, int rays, std::uint64_t seed,
                 RayWork& work) const {
    const SurfacePoint& point = place.point;
    SpreadPairs pairs(seed);
    const int plane = scene->surfaces[at(place.surface)].plane;
    for (int k = 0; k < rays; ++k) {
      const auto [s, t] = pairs.next();
      const Vec3 end = triangle ? point_of(*triangle, s, t) : emitter.point(s, t);
      const double weight = light_along(point, emitter.target, end - point.position);
      if (!(weight > 0)) continue;
      work.segments.push_back({point.position, end, plane, emitter.plane});
      work.weights.push_back(weight);
    }
    work.groups.push_back({factor, work.segments.size()});
  }

  NoisyValue gather(const FieldPoint& place, RayWork& work) const {
    collect_looks(place.point, work.looks);
    cut_uneven(place.point, work);
    share_rays(work.looks);
    work.segments.clear();
    work.weights.clear();
    work.groups.clear();
    work.ends.clear();
    for (const Look& look : work.looks) {
      const std::uint64_t seed = seed_of(place.point.position, look.emitter->target);
      add_rays(place, look, seed, work);
      add_rays(place, look, ~seed, work);
    }
    work.blocked.resize(work.segments.size());
    visibility->blocked(work.segments, work.blocked);
    NoisyValue irradiance;
    std::size_t ray = 0, group = 0;
    for (std::size_t k = 0; k < work.looks.size(); ++k) {
      const Look& look = work.looks[k];
      const double first = share(work, ray, group, work.ends[2 * k]);
      const double second = share(work, ray, group, work.ends[2 * k + 1]);
      const Rgb& exitance = look.emitter->target.exitance;
      if (first >= 0 && second >= 0) {
        irradiance.a += look.factor * first * exitance;
        irradiance.b += look.factor * second * exitance;
        continue;
      }
      const Rgb exactly = exact->factor(place.point, look.emitter->surface).visible * exitance;
      irradiance.a += exactly;
      irradiance.b += exactly;
    }
    return irradiance;
  }

  /// What share of the light of the groups up to one arrives; −1 if no ray tells.
  static double share(const RayWork& work, std::size_t& ray, std::size_t& group, std::size_t end) {
    double told = 0, arrives = 0;
    for (; group < end; ++group) {
      double all = 0, free = 0;
      for (; ray < work.groups[group].end; ++ray) {
        all += work.weights[ray];
        if (work.blocked[ray] == 0) free += work.weights[ray];
      }
      if (!(all > 0)) continue;
      told += work.groups[group].factor;
      arrives += work.groups[group].factor * free / all;
    }
    return told > 0 ? arrives / told : -1;
  }
};

RayLight::RayLight(const SoundScene& scene, const DirectLightIndex& exact,
                   const VisibilityIndex& visibility, const RayLightOptions& options)
    : impl_(std::make_unique<Impl>(Impl{&scene, &exact, &visibility, options, {}})) {
  if (!(options.deviation > 0 && std::isfinite(options.deviation)) || !(options.most_rays >= 1))
    throw Error(ErrorCode::contract, "RayLight",
                fmt::format("deviation ({}) or most_rays ({}) is out of range", options.deviation,
                            options.most_rays));
  impl_->options.most_rays =
      std::min(options.most_rays, double{std::numeric_limits<std::int32_t>::max()});
  for (const int id : exact.emitters()) {
    RayEmitter emitter = make_ray_emitter(scene, id);
    if (!emitter.triangles.empty()) impl_->emitters.push_back(std::move(emitter));
  }
}
RayLight::~RayLight() = default;
RayLight::RayLight(RayLight&&) noexcept = default;

std::vector<NoisyValue> RayLight::irradiance(std::span<const FieldPoint> places,
                                             const Progress& progress) const {
  std::vector<NoisyValue> result(places.size());
  parallel_for((places.size() + places_of_task - 1) / places_of_task,
               [&](std::size_t c) {
                 RayWork work;
                 const std::size_t end = std::min(places.size(), (c + 1) * places_of_task);
                 for (std::size_t k = c * places_of_task; k < end; ++k)
                   result[k] = impl_->gather(places[k], work);
               },
               progress, "direct light by rays");
  return result;
}

double RayLight::unobstructed(const SurfacePoint& point) const {
  std::vector<Look> looks;
  impl_->collect_looks(point, looks);
  double sum = 0;
  for (const Look& look : looks) sum += look.strength;
  return sum;
}

double RayLight::cost(const SurfacePoint& point) const {
  RayWork work;
  impl_->collect_looks(point, work.looks);
  impl_->cut_uneven(point, work);
  impl_->share_rays(work.looks);
  double sum = 0;
  for (const Look& look : work.looks)
    sum += look.rays > 0 ? 2 * look.rays : impl_->options.most_rays;
  return sum;
}

Region RayLight::region(const std::array<Vec3, 3>& triangle, const Vec3& normal,
                        int surface) const {
  std::vector<Look> looks;
  const Vec3 centre = (triangle[0] + triangle[1] + triangle[2]) / 3;
  impl_->collect_looks({centre, normal}, looks);
  if (looks.empty()) return Region::away;
  const RayEmitter& emitter = *looks.front().emitter;
  SpreadPairs starts(seed_of(centre, emitter.target)), ends(~seed_of(centre, emitter.target));
  std::vector<Segment> segments;
  for (int k = 0; k < rays_of_region; ++k) {
    auto [s, t] = starts.next();
    const auto [u, v] = ends.next();
    if (s + t > 1) s = 1 - s, t = 1 - t;
    const Vec3 from =
        triangle[0] + s * (triangle[1] - triangle[0]) + t * (triangle[2] - triangle[0]);
    const Vec3 to = emitter.point(u, v);
    if (normal.dot(to - from) > 0)
      segments.push_back({from, to, impl_->scene->surfaces[at(surface)].plane, emitter.plane});
  }
  std::vector<std::uint8_t> blocked(segments.size());
  impl_->visibility->blocked(segments, blocked);
  const auto hidden = std::count(blocked.begin(), blocked.end(), std::uint8_t{1});
  if (blocked.empty()) return Region::away;
  return hidden == 0                     ? Region::lit
         : hidden == std::ssize(blocked) ? Region::umbra
                                         : Region::penumbra;
}

}  // namespace halfshade
