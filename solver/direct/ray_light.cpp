#include "solver/direct/ray_light.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/geometry/spread_pairs.h"
#include "solver/direct/emitter_parts.h"
#include "solver/direct/ray_looks.h"
#include "solver/direct/ray_shares.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace halfshade {
namespace {

constexpr std::size_t places_of_task = 64;

/// Of the deviation: light of a part of an emitter that need not be even.
constexpr double negligible = 0.5;
/// The same: light of an emitter that is not worth rays of its own, and the most that a group of
/// them may give that are not looked at one by one.
constexpr double surely_drawn = 0.02, weak_group = 0.02;
/// Rays that tell what an element sees of an emitter.
constexpr int rays_of_region = 16;
/// Of so many points of an emitter that is drawn, one is taken by the light along.
constexpr int points_of_draw = 4;

/// An emitter that was drawn.
struct Draw {
  const RayEmitter* emitter;
  double light;  ///< in units of what each draw stands for; about 1
  bool has_ray;  ///< which is to tell if that arrives
};

/// Buffers of one task.
struct RayWork {
  double deviation = 0;  ///< allowed of what arrives, in W/m²
  std::vector<RayLook> looks;
  std::vector<RayShare> shares;  ///< of rays: one a look
  DrawnRays drawn;
  std::vector<const RayLook*> may_be_drawn;
  std::vector<Draw> draws;      ///< of one estimate, then of the other
  std::size_t second_draw = 0;  ///< where those begin
  std::vector<EmitterPart> parts;
  std::vector<Segment> segments;
  std::vector<double> weights;
  std::vector<std::size_t> ends;  ///< of the segments of both estimates of each look
  std::vector<std::uint8_t> blocked;
  double exact_work = 0;  ///< of looks from the place, in rays
};

}  // namespace

struct RayLight::Impl {
  const SoundScene* scene;
  const DirectLightIndex* exact;
  const VisibilityIndex* visibility;
  RayLightOptions options;
  EmitterTree tree;

  /// What is looked at, and how many rays that takes, if `slack` times the deviation will do.
  void share(const SurfacePoint& point, double slack, RayWork& work) const {
    work.deviation = slack * options.deviation;
    collect_looks(tree, point, weak_group * work.deviation, work.looks);
    work.parts.clear();
    work.shares.clear();
    for (RayLook& look : work.looks) {
      RayShare& share = work.shares.emplace_back();
      share.strength = look.strength / work.deviation;
      if (!look.emitter || (look.is_rough && share.strength < surely_drawn))
        share.way = RayWay::drawn;
      else if (!look.is_rough)
        cut_uneven(point, look, share, work);
    }
    work.drawn = share_rays(work.shares, options.most_rays);
    for (std::size_t k = 0; k < work.looks.size(); ++k)
      if (work.looks[k].is_rough && work.shares[k].way != RayWay::drawn)
        work.looks[k].factor = exact_factor(point, *work.looks[k].emitter);
  }

  /// Rays to emitters over which light varies much are as likely as the light along them, unless
  /// those are weak.
  static void cut_uneven(const SurfacePoint& point, RayLook& look, RayShare& share, RayWork& work) {
    if (is_even(point, look.emitter->target, look.emitter->area(), look.factor)) return;
    if (share.strength < negligible) {
      share.way = RayWay::drawn;
      return;
    }
    look.first_part = work.parts.size();
    add_parts(point, look.emitter->triangles, work.parts);
    look.end_part = work.parts.size();
  }

  /// Adds the rays of one estimate of a look, without those below the point's horizon.
  void add_rays(const FieldPoint& place, const RayLook& look, int count, std::uint64_t seed,
                RayWork& work) const {
    const RayEmitter& emitter = *look.emitter;
    SpreadPairs pairs(seed);
    if (look.first_part < look.end_part) {
      const LightDraw light(
          std::span(work.parts).subspan(look.first_part, look.end_part - look.first_part));
      for (int k = 0; k < count; ++k) {
        const auto [s, t] = pairs.next();
        const LightPoint end = light.point(s, t);
        add_ray(place, emitter, place.point.position + end.way, end.weight, work);
      }
    } else {
      for (int k = 0; k < count; ++k) {
        const auto [s, t] = pairs.next();
        const Vec3 end = emitter.point(s, t);
        const double weight = light_along(place.point, emitter.target, end - place.point.position);
        if (weight > 0) add_ray(place, emitter, end, weight, work);
      }
    }
    work.ends.push_back(work.segments.size());
  }

  void add_ray(const FieldPoint& place, const RayEmitter& emitter, const Vec3& end, double weight,
               RayWork& work) const {
    const int plane = scene->surfaces[at(place.surface)].plane;
    work.segments.push_back({place.point.position, end, plane, emitter.plane});
    work.weights.push_back(weight);
  }

  /// Adds the rays of one estimate of all emitters that are drawn: each as often as it is strong,
  /// at even steps along the list of them.
  void draw(const FieldPoint& place, std::uint64_t seed, RayWork& work) const {
    const double step = work.drawn.strength * work.deviation / work.drawn.rays;
    double next = unit_share(mix_bits(seed)) * step, reached = 0;
    int left = work.drawn.rays;
    SpreadPairs pairs(mix_bits(seed + splitmix_step));
    std::uint64_t choice = mix_bits(seed + 2 * splitmix_step);
    for (const RayLook* look : work.may_be_drawn) {
      reached += look->strength;
      const bool is_last = look == work.may_be_drawn.back();
      double light = look->is_rough || !look->emitter ? -1 : look->strength;  // < 0: not known
      for (; left > 0 && (next < reached || is_last); next += step) {
        --left;
        choice = mix_bits(choice);
        DrawnEmitter drawn{look->emitter, look->strength};
        if (!look->emitter) drawn = draw_emitter(tree, look->group, place.point, ~choice);
        if (!drawn.emitter) continue;
        if (light < 0 || !look->emitter) light = exact_light(place.point, *drawn.emitter);
        if (light > 0) add_draw(place, drawn, light, unit_share(choice), pairs, work);
      }
    }
  }

  /// `light`: what an emitter gives if nothing is in between.
  void add_draw(const FieldPoint& place, const DrawnEmitter& drawn, double light, double choice,
                SpreadPairs& pairs, RayWork& work) const {
    const RayEmitter& emitter = *drawn.emitter;
    const auto end = point_of_draw(place.point, emitter, choice, pairs, work);
    if (!end) light = look_exactly(place, emitter, work).mean();
    work.draws.push_back({&emitter, light / drawn.light, !!end});
    if (!end) return;
    const int plane = scene->surfaces[at(place.surface)].plane;
    work.segments.push_back({place.point.position, *end, plane, emitter.plane});
  }

  /// A point of an emitter, more likely where more light comes from; none if none does.
  static std::optional<Vec3> point_of_draw(const SurfacePoint& point, const RayEmitter& emitter,
                                           double choice, SpreadPairs& pairs, RayWork& work) {
    std::array<Vec3, points_of_draw> ends;
    std::array<double, points_of_draw> reached;
    double sum = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const auto [s, t] = pairs.next();
      ends[k] = emitter.point(s, t);
      reached[k] = sum += light_along(point, emitter.target, ends[k] - point.position);
    }
    if (!(sum > 0)) {
      const std::size_t first = work.parts.size();
      add_parts(point, emitter.triangles, work.parts);
      if (work.parts.size() == first) return std::nullopt;
      const auto [s, t] = pairs.next();
      return point.position + LightDraw(std::span(work.parts).subspan(first)).point(s, t).way;
    }
    const auto first = std::upper_bound(reached.begin(), reached.end() - 1, choice * sum);
    return ends[static_cast<std::size_t>(first - reached.begin())];
  }

  Rgb look_exactly(const FieldPoint& place, const RayEmitter& emitter, RayWork& work) const {
    const DirectLight light = exact->irradiance(place.point, emitter.surface);
    work.exact_work += in_rays(light.effort, static_cast<double>(light.crowd_work));
    return light.irradiance;
  }

  /// If nothing is in between.
  static double exact_light(const SurfacePoint& point, const RayEmitter& emitter) {
    return is_clearly_away(emitter.target, point)
               ? 0
               : exact_factor(point, emitter) * emitter.target.strength;
  }

  /// Rays for those that are drawn, in the order of emitters.
  void add_draws(const FieldPoint& place, RayWork& work) const {
    work.draws.clear();
    work.second_draw = 0;
    work.may_be_drawn.clear();
    for (std::size_t k = 0; k < work.looks.size(); ++k)
      if (work.shares[k].way == RayWay::drawn) work.may_be_drawn.push_back(&work.looks[k]);
    if (work.may_be_drawn.empty()) return;
    const RayLook& first = *work.may_be_drawn.front();
    const RayEmitter& emitter = first.emitter ? *first.emitter : first_of(tree, first.group);
    const std::uint64_t seed = mix_bits(seed_of(place.point.position, emitter.target));
    draw(place, seed, work);
    work.second_draw = work.draws.size();
    draw(place, ~seed, work);
  }

  /// What arrives of emitters that are drawn: each draw stands for as much light.
  void gather_draws(const RayWork& work, std::size_t ray, NoisyValue& irradiance) const {
    const double each = work.drawn.strength * work.deviation / std::max(work.drawn.rays, 1);
    for (std::size_t k = 0; k < work.draws.size(); ++k) {
      const Draw& draw = work.draws[k];
      if (draw.has_ray && work.blocked[ray++] != 0) continue;
      const EmitterTarget& target = draw.emitter->target;
      (k < work.second_draw ? irradiance.a : irradiance.b) +=
          draw.light * each / target.strength * target.exitance;
    }
  }

  NoisyValue gather(const FieldPoint& place, double slack, RayWork& work) const {
    share(place.point, slack, work);
    work.exact_work = 0;
    work.segments.clear();
    work.weights.clear();
    work.ends.clear();
    for (std::size_t k = 0; k < work.looks.size(); ++k) {
      const RayLook& look = work.looks[k];
      if (work.shares[k].way == RayWay::drawn) continue;
      const std::uint64_t seed = seed_of(place.point.position, look.emitter->target);
      add_rays(place, look, work.shares[k].rays, seed, work);
      add_rays(place, look, work.shares[k].rays, ~seed, work);
    }
    add_draws(place, work);
    work.blocked.resize(work.segments.size());
    visibility->blocked(work.segments, work.blocked);
    NoisyValue irradiance;
    std::size_t ray = 0, end = 0;
    for (std::size_t k = 0; k < work.looks.size(); ++k) {
      if (work.shares[k].way == RayWay::drawn) continue;
      const RayLook& look = work.looks[k];
      const double first = share_that_arrives(work, ray, work.ends[end++]);
      const double second = share_that_arrives(work, ray, work.ends[end++]);
      const Rgb& exitance = look.emitter->target.exitance;
      if (first >= 0 && second >= 0) {
        irradiance.a += look.factor * first * exitance;
        irradiance.b += look.factor * second * exitance;
        continue;
      }
      const Rgb exactly = look_exactly(place, *look.emitter, work);
      irradiance.a += exactly;
      irradiance.b += exactly;
    }
    gather_draws(work, ray, irradiance);
    return irradiance;
  }

  /// Of the light along rays up to one; −1 if there are none.
  static double share_that_arrives(const RayWork& work, std::size_t& ray, std::size_t end) {
    double all = 0, free = 0;
    for (; ray < end; ++ray) {
      all += work.weights[ray];
      if (work.blocked[ray] == 0) free += work.weights[ray];
    }
    return all > 0 ? free / all : -1;
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
  std::vector<RayEmitter> emitters;
  for (const int id : exact.emitters()) {
    RayEmitter emitter = make_ray_emitter(scene, id);
    if (!emitter.triangles.empty()) emitters.push_back(std::move(emitter));
  }
  impl_->tree = make_emitter_tree(std::move(emitters));
}
RayLight::~RayLight() = default;
RayLight::RayLight(RayLight&&) noexcept = default;

RayIrradiance RayLight::irradiance(std::span<const FieldPoint> places,
                                   std::span<const double> slack, const Progress& progress) const {
  if (!slack.empty() && slack.size() != places.size())
    throw Error(ErrorCode::contract, "RayLight",
                fmt::format("{} places and {} slacks", places.size(), slack.size()));
  RayIrradiance result{std::vector<NoisyValue>(places.size())};
  std::vector<std::size_t> rays((places.size() + places_of_task - 1) / places_of_task);
  parallel_for(
      rays.size(),
      [&](std::size_t c) {
        RayWork work;
        const std::size_t end = std::min(places.size(), (c + 1) * places_of_task);
        for (std::size_t k = c * places_of_task; k < end; ++k) {
          result.at[k] = impl_->gather(places[k], slack.empty() ? 1 : slack[k], work);
          rays[c] += work.segments.size() + static_cast<std::size_t>(work.exact_work);
        }
      },
      progress, "direct light by rays");
  result.rays = std::accumulate(rays.begin(), rays.end(), std::size_t{0});
  return result;
}

double RayLight::unobstructed(const SurfacePoint& point) const {
  std::vector<RayLook> looks;
  collect_looks(impl_->tree, point, weak_group * impl_->options.deviation, looks);
  double sum = 0;
  for (const RayLook& look : looks) sum += (look.is_rough ? 1 + far_error : 1) * look.strength;
  return sum;
}

double RayLight::cost(const SurfacePoint& point) const {
  RayWork work;
  impl_->share(point, 1, work);
  double sum = 2 * work.drawn.rays;
  for (const RayShare& share : work.shares)
    if (share.way != RayWay::drawn)
      sum += share.way == RayWay::own ? 2 * share.rays : impl_->options.most_rays;
  return sum;
}

Region RayLight::region(const std::array<Vec3, 3>& triangle, const Vec3& normal,
                        int surface) const {
  const Vec3 centre = (triangle[0] + triangle[1] + triangle[2]) / 3;
  const RayEmitter* strongest = strongest_emitter(impl_->tree, {centre, normal});
  if (!strongest) return Region::away;
  const RayEmitter& emitter = *strongest;
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
