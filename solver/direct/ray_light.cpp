#include "solver/direct/ray_light.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/triangulation/ring_triangles.h"
#include "solver/direct/emitter_target.h"

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
/// Where light from corners of an emitter differs by more than this factor, its visible part is
/// looked for: a share by weights is biased as they vary.
constexpr double uneven = 3;
/// Rays that tell what an element sees of an emitter.
constexpr int rays_of_region = 16;
/// Directions that differ by less draw the same random numbers; above the rounding of coordinates.
constexpr double same_direction = 0x1p-24;

/// An emitter as triangles, to draw points of it.
struct RayEmitter {
  EmitterTarget target;
  int surface = 0, plane = 0;
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<double> reached;  ///< area of all triangles up to each

  Vec3 point(double s, double t) const {
    const double along = s * reached.back();
    const auto first = std::upper_bound(reached.begin(), reached.end() - 1, along);
    const auto k = static_cast<std::size_t>(first - reached.begin());
    const double from = k == 0 ? 0 : reached[k - 1];
    const double rest = std::clamp((along - from) / (reached[k] - from), 0., 1.);
    const double width = std::sqrt(rest);
    const auto& [a, b, c] = triangles[k];
    return a + width * (b - a + t * (c - b));
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
    s_ = std::fmod(s_ + 1 / root, 1.);
    t_ = std::fmod(t_ + 1 / (root * root), 1.);
    return {s_, t_};
  }

 private:
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

/// cos θ cos θ' / r² of a way from a point to an emitter.
double kernel(const SurfacePoint& point, const EmitterTarget& target, const Vec3& way) {
  const double square = way.squaredNorm();
  return std::max(point.normal.dot(way), 0.) * std::max(-target.normal.dot(way), 0.) /
         (square * square);
}

bool is_uneven(const EmitterTarget& target, const SurfacePoint& point) {
  double least = HUGE_VAL, most = 0;
  for (const auto& ring : target.rings)
    for (const Vec3& corner : ring) {
      const double light = kernel(point, target, corner - point.position);
      least = std::min(least, light);
      most = std::max(most, light);
    }
  return !(most <= uneven * least);
}

/// What rays to one emitter are to tell.
struct Look {
  const RayEmitter* emitter;
  double factor;    ///< form factor if nothing is in between
  double strength;  ///< light that gives
  bool is_uneven;   ///< light varies so much over the emitter that few rays would be biased
  int rays = 0;     ///< for one of two estimates; 0: its visible part is looked for
};

/// Buffers of one thread.
struct RayWork {
  std::vector<Look> looks;
  std::vector<Segment> segments;
  std::vector<double> weights;
  std::vector<std::size_t> ends;  ///< of the segments of both estimates of each look
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
      if (factor > 0)
        looks.push_back({&emitter, factor, factor * target.strength, is_uneven(target, point)});
    }
    std::stable_sort(looks.begin(), looks.end(),
                     [](const Look& a, const Look& b) { return a.strength > b.strength; });
  }

  /// The fewest rays in all with which the variances sum to what is allowed.
  void share_rays(std::vector<Look>& looks) const {
    constexpr double power = 2 / (power_of_rays + 1);
    const double variance = options.deviation * options.deviation / variance_of_rays;
    const auto first_even = std::stable_partition(looks.begin(), looks.end(),
                                                  [](const Look& look) { return look.is_uneven; });
    double sum = 0;
    for (auto look = first_even; look != looks.end(); ++look)
      sum += std::pow(look->strength, power);
    for (auto look = first_even; look != looks.end(); ++look) {
      const double each = std::pow(sum / variance, 1 / power_of_rays);
      const double rays = std::ceil(each * std::pow(look->strength, power));
      if (rays > options.most_rays) {
        sum -= std::pow(look->strength, power);
        continue;
      }
      look->rays = std::max(static_cast<int>(std::ceil(rays / 2)), 1);
    }
  }

  /// Adds the rays of a look, without those below the point's horizon.
  void add_rays(const FieldPoint& place, const Look& look, std::uint64_t seed,
                RayWork& work) const {
    const SurfacePoint& point = place.point;
    SpreadPairs pairs(seed);
    const int plane = scene->surfaces[at(place.surface)].plane;
    for (int k = 0; k < look.rays; ++k) {
      const auto [s, t] = pairs.next();
      const Vec3 end = look.emitter->point(s, t);
      const double weight = kernel(point, look.emitter->target, end - point.position);
      if (!(weight > 0)) continue;
      work.segments.push_back({point.position, end, plane, look.emitter->plane});
      work.weights.push_back(weight);
    }
    work.ends.push_back(work.segments.size());
  }

  NoisyValue gather(const FieldPoint& place, RayWork& work) const {
    collect_looks(place.point, work.looks);
    share_rays(work.looks);
    work.segments.clear();
    work.weights.clear();
    work.ends.clear();
    for (const Look& look : work.looks) {
      const std::uint64_t seed = seed_of(place.point.position, look.emitter->target);
      add_rays(place, look, seed, work);
      add_rays(place, look, ~seed, work);
    }
    work.blocked.resize(work.segments.size());
    visibility->blocked(work.segments, work.blocked);
    NoisyValue irradiance;
    std::size_t next = 0;
    for (std::size_t k = 0; k < work.looks.size(); ++k) {
      const Look& look = work.looks[k];
      const double first = share(work, next, work.ends[2 * k]);
      const double second = share(work, next, work.ends[2 * k + 1]);
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

  /// What share of the light along rays up to one arrives; −1 if there are none.
  static double share(const RayWork& work, std::size_t& next, std::size_t end) {
    double all = 0, arrives = 0;
    for (; next < end; ++next) {
      all += work.weights[next];
      if (work.blocked[next] == 0) arrives += work.weights[next];
    }
    return all > 0 ? arrives / all : -1;
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
  std::vector<Look> looks;
  impl_->collect_looks(point, looks);
  impl_->share_rays(looks);
  double sum = 0;
  for (const Look& look : looks) sum += look.rays > 0 ? 2 * look.rays : impl_->options.most_rays;
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
