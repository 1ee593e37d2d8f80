#include "io/read/read_scene.h"
#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/rays/visibility.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "tests/support/places.h"
#include "tests/support/sound_scenes.h"

#include <benchmark/benchmark.h>

#include <chrono>

// Exact direct light against the best Monte-Carlo estimate we know how to write, in one run and on
// all threads.

namespace halfshade {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Shadow rays: points stratified over the rectangular light with one jittered point a cell, in
/// tiles of 4 × 4 that Embree traces as packets, weighted with the exchange kernel; their visible
/// part times the closed form of the whole light, so that only the shadow is noisy.
class ShadowRays {
 public:
  ShadowRays(const SoundScene& scene, const DirectLightIndex& index)
      : scene_(scene), index_(index), visibility_(occluders(scene)) {}

  /// Irradiance for E = 1 at all points, with cells² rays for each point and emitter.
  std::vector<double> irradiance(const std::vector<SurfacePoint>& points, int cells) const {
    std::vector<double> result(points.size());
    parallel_for(points.size(), [&](std::size_t k) {
      Buffers buffers;
      for (const int emitter : index_.emitters())
        result[k] += factor(points[k], emitter, cells, k * 1000003 + 17, buffers);
    });
    return result;
  }

 private:
  static constexpr std::size_t batch = 4096;  // traced on the calling thread

  struct Buffers {
    std::vector<Segment> segments;
    std::vector<double> weights;
    std::vector<std::uint8_t> blocked;
    double visible = 0, all = 0;
  };

  double factor(const SurfacePoint& point, int emitter, int cells, std::uint64_t seed,
                Buffers& buffers) const {
    const double whole = unobstructed(point, emitter);
    if (!(whole > 0)) return 0;
    buffers.visible = buffers.all = 0;
    const Surface& light = scene_.surfaces[static_cast<std::size_t>(emitter)];
    const Ring& ring = light.rings.front();
    const Vec3 origin = light.frame.to_space(ring[0]);
    const Vec3 a = light.frame.to_space(ring[1]) - origin;
    const Vec3 b = light.frame.to_space(ring[3]) - origin;
    std::uint64_t state = seed;
    const auto random = [&state] {  // splitmix64
      const std::uint64_t z = mix_bits(state);
      state += splitmix_step;
      return static_cast<double>(z >> 11) * 0x1p-53;
    };
    for (int tile_j = 0; tile_j < cells; tile_j += 4)
      for (int tile_i = 0; tile_i < cells; tile_i += 4)
        for (int j = tile_j; j < std::min(cells, tile_j + 4); ++j)
          for (int i = tile_i; i < std::min(cells, tile_i + 4); ++i) {
            const Vec3 q = origin + (i + random()) / cells * a + (j + random()) / cells * b;
            add_ray(point, q, light, buffers);
          }
    trace(buffers);
    return buffers.all > 0 ? whole * buffers.visible / buffers.all : 0;
  }

  /// Looked up once a point and emitter, for no estimate needs to compute it again.
  double unobstructed(const SurfacePoint& point, int emitter) const {
    const Surface& light = scene_.surfaces[static_cast<std::size_t>(emitter)];
    std::vector<Vec3> corners;
    for (const Vec2& p : light.rings.front()) corners.push_back(light.frame.to_space(p));
    double sum = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec3 r = corners[k] - point.position;
      const Vec3 s = corners[(k + 1) % corners.size()] - point.position;
      const Vec3 c = r.cross(s);
      sum -= std::atan2(c.norm(), r.dot(s)) / c.norm() * point.normal.dot(c);
    }
    return sum / (2 * M_PI);
  }

  void add_ray(const SurfacePoint& point, const Vec3& q, const Surface& light,
               Buffers& buffers) const {
    const Vec3 to = q - point.position;
    const double r2 = to.squaredNorm();
    const double weight = point.normal.dot(to) * -light.frame.normal.dot(to) / (r2 * r2);
    buffers.segments.push_back({point.position, q, -1, light.plane});
    buffers.weights.push_back(weight);
    if (buffers.segments.size() == batch) trace(buffers);
  }

  void trace(Buffers& buffers) const {
    buffers.blocked.resize(buffers.segments.size());
    visibility_.blocked(buffers.segments, buffers.blocked);
    for (std::size_t k = 0; k < buffers.weights.size(); ++k) {
      buffers.all += buffers.weights[k];
      if (!buffers.blocked[k]) buffers.visible += buffers.weights[k];
    }
    buffers.segments.clear();
    buffers.weights.clear();
  }

  const SoundScene& scene_;
  const DirectLightIndex& index_;
  VisibilityIndex visibility_;
};

/// Seconds for each point that shadow rays take to each RMS error relative to the RMS irradiance;
/// beyond `budget` seconds extrapolated with the last slope.
struct TimeToError {
  double to_1e3 = 0, to_1e5 = 0;
  bool extrapolated = false;
};

TimeToError time_to_error(const ShadowRays& rays, const std::vector<SurfacePoint>& points,
                          const std::vector<DirectLight>& exact, double budget) {
  double scale = 0;
  for (const DirectLight& light : exact) scale += light.irradiance[0] * light.irradiance[0];
  TimeToError result;
  double last_error = 0, last_time = 0, slope = -4. / 3;  // of log time over log error
  const auto interpolated = [&](double target, double error, double time) {
    return time * std::pow(target / error, slope);
  };
  for (int cells = 8;; cells *= 2) {
    const auto start = Clock::now();
    const std::vector<double> estimate = rays.irradiance(points, cells);
    const double time = seconds_since(start) / static_cast<double>(points.size());
    double sum = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
      sum += std::pow(estimate[k] - exact[k].irradiance[0], 2);
    const double error = std::sqrt(sum / scale);
    if (last_error > error && time > last_time)
      slope = std::log(time / last_time) / std::log(error / last_error);
    if (result.to_1e3 == 0 && error <= 1e-3) result.to_1e3 = interpolated(1e-3, error, time);
    const bool last = time * static_cast<double>(points.size()) > budget;
    if (error <= 1e-5 || last) {
      result.extrapolated = error > 1e-5;
      if (result.to_1e3 == 0) result.to_1e3 = interpolated(1e-3, error, time);
      result.to_1e5 = interpolated(1e-5, error, time);
      return result;
    }
    last_error = error;
    last_time = time;
  }
}

/// Seconds for each point of a batch, after a first one that fills buffers.
double exact_seconds(const DirectLightIndex& index, const std::vector<SurfacePoint>& points) {
  std::vector<SurfacePoint> many;
  while (many.size() < 2000) many.insert(many.end(), points.begin(), points.end());
  index.irradiance(many);
  double best = 1e9;
  const auto begin = Clock::now();
  for (int k = 0; k < 3 || (k < 10 && seconds_since(begin) < 1); ++k) {
    const auto start = Clock::now();
    benchmark::DoNotOptimize(index.irradiance(many).data());
    best = std::min(best, seconds_since(start) / static_cast<double>(many.size()));
  }
  return best;
}

/// Points on the floor in the penumbra of the strongest light.
std::vector<SurfacePoint> penumbra_points(const DirectLightIndex& index, double half,
                                          std::size_t count) {
  test::Random random(3);
  std::vector<SurfacePoint> points;
  for (int tries = 0; points.size() < count && tries < 100000; ++tries) {
    const SurfacePoint p{random.in_box({-half, -half, 0}, {half, half, 0}), Vec3::UnitZ()};
    if (index.irradiance(p).region == Region::penumbra) points.push_back(p);
  }
  return points;
}

void compare(benchmark::State& state, const SoundScene& scene, double half, std::size_t count,
             double budget) {
  for (auto _ : state) {
    const DirectLightIndex index(scene);
    const std::vector<SurfacePoint> points = penumbra_points(index, half, count);
    const std::vector<DirectLight> exact = index.irradiance(points);
    const double ours = exact_seconds(index, points);
    const TimeToError theirs = time_to_error(ShadowRays(scene, index), points, exact, budget);
    state.counters["exact_us"] = 1e6 * ours;
    state.counters["rays_us_1e-3"] = 1e6 * theirs.to_1e3;
    state.counters["rays_us_1e-5"] = 1e6 * theirs.to_1e5;
    state.counters["ratio_1e-3"] = theirs.to_1e3 / ours;
    state.counters["ratio_1e-5"] = theirs.to_1e5 / ours;
    state.counters["extrapolated"] = theirs.extrapolated;
  }
}

void direct_light_of_file(benchmark::State& state, const std::string& name, double half,
                          std::size_t count) {
  const std::filesystem::path path = std::filesystem::path(test::data_folder) / (name + ".obj");
  compare(state, make_sound(read_scene(path).scene), half, count, 8);
}
BENCHMARK_CAPTURE(direct_light_of_file, s1, "s1", 1.3, 64)->Iterations(1);
BENCHMARK_CAPTURE(direct_light_of_file, bars, "bars", 1.8, 64)->Iterations(1);
BENCHMARK_CAPTURE(direct_light_of_file, sphere, "sphere", 1.8, 64)->Iterations(1);
BENCHMARK_CAPTURE(direct_light_of_file, hundred_lights, "hundred_lights", 5.5, 32)->Iterations(1);

/// A unit light two units above the floor, a half-unit occluder half way. For scale: a published
/// Monte-Carlo package needs 524,288 shadow rays and 0.46 s for a point at an RMS error of 1e-5.
void direct_light_of_half_unit_occluder(benchmark::State& state) {
  SoundScene scene = test::empty_sound_scene(5);
  const auto square = [](double h, double z, bool down) {
    std::vector<Vec3> p = {{-h, -h, z}, {h, -h, z}, {h, h, z}, {-h, h, z}};
    if (down) std::reverse(p.begin(), p.end());
    return p;
  };
  test::add_surface(scene, {square(0.5, 2, true)}, 1);
  test::add_surface(scene, {square(0.25, 1, false)}, 0);
  test::add_surface(scene, {square(2, 0, false)}, 0);
  compare(state, scene, 1, 64, 8);
}
BENCHMARK(direct_light_of_half_unit_occluder)->Iterations(1);

/// Faces of a sphere of radius 0.3 at height 1.2, by halving those of an icosahedron.
std::vector<std::array<Vec3, 3>> sphere_faces(int level) {
  if (level == 0) {
    const double t = (1 + std::sqrt(5.)) / 2;
    const std::array<Vec3, 12> v = {{{-1, t, 0},
                                     {1, t, 0},
                                     {-1, -t, 0},
                                     {1, -t, 0},
                                     {0, -1, t},
                                     {0, 1, t},
                                     {0, -1, -t},
                                     {0, 1, -t},
                                     {t, 0, -1},
                                     {t, 0, 1},
                                     {-t, 0, -1},
                                     {-t, 0, 1}}};
    constexpr int f[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    std::vector<std::array<Vec3, 3>> faces;
    for (const auto& k : f)
      faces.push_back({v[static_cast<std::size_t>(k[0])].normalized(),
                       v[static_cast<std::size_t>(k[1])].normalized(),
                       v[static_cast<std::size_t>(k[2])].normalized()});
    return faces;
  }
  std::vector<std::array<Vec3, 3>> finer;
  for (const auto& [a, b, c] : sphere_faces(level - 1)) {
    const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
    finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return finer;
}

double seconds_under_sphere(int level) {
  Scene scene;
  const int dark = test::add_material(scene, 0, 0), bright = test::add_material(scene, 0, 1);
  test::add_polygon(scene, {{-1, -1, 3}, {-1, 1, 3}, {1, 1, 3}, {1, -1, 3}}, bright);
  for (const auto& face : sphere_faces(level)) {
    std::vector<Vec3> corners;
    for (const Vec3& p : face) corners.push_back(0.3 * p + Vec3(0, 0, 1.2));
    test::add_polygon(scene, corners, dark);
  }
  const DirectLightIndex index(make_sound(scene));
  return exact_seconds(index, penumbra_points(index, 1, 500));
}

/// How cost grows with the faces of a sphere of the same outline.
void direct_light_under_spheres(benchmark::State& state) {
  for (auto _ : state) {
    const std::array<double, 3> faces = {80, 1280, 20480};
    std::array<double, 3> time{};
    for (std::size_t k = 0; k < 3; ++k) time[k] = seconds_under_sphere(static_cast<int>(2 * k + 1));
    for (std::size_t k = 0; k < 3; ++k)
      state.counters["us_" + std::to_string(static_cast<int>(faces[k]))] = 1e6 * time[k];
    // The middle one lies half way, so that the least-squares line has the slope of the ends.
    state.counters["exponent"] = std::log(time[2] / time[0]) / std::log(faces[2] / faces[0]);
  }
}
BENCHMARK(direct_light_under_spheres)->Iterations(1);

}  // namespace
}  // namespace halfshade
