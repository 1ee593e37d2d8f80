#include "meshing/core/light_source.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "tests/support/room_families.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

// How time, memory and the number of curves and elements grow with the number of polygons.
//   halfshade_scale                      families A, B and K from 100 to 3,000 polygons
//   halfshade_scale A 1500 [tolerance]   one of them; the tolerance is a share of the mean
//                                        irradiance of the floor, 0.01 unless given; 0: all curves
// Each scene is a process of its own, for its peak memory.

namespace halfshade {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Row {
  int polygons = 0;
  double find = 0, mesh = 0;  ///< seconds
  double megabytes = 0;
  std::size_t silhouettes = 0, swaths = 0, curves = 0, merged = 0, kept = 0, culled = 0;
  std::array<std::size_t, curve_kinds> found{};
  int elements = 0;
};

double megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

double mean_on_floor(const SoundScene& scene) {
  const DirectLightIndex index(scene);
  constexpr int side = 24;
  double sum = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const SurfacePoint point{
          {test::room_width * (i + 0.5) / side, test::room_width * (j + 0.5) / side, 0},
          Vec3::UnitZ()};
      sum += index.irradiance(point).irradiance.maxCoeff();
    }
  return sum / (side * side);
}

Row measure(char kind, int polygons, double tolerance) {
  const Scene input = test::family(kind, polygons);
  const SoundScene scene = make_sound(input);
  Row row;
  row.polygons = static_cast<int>(input.faces.size());
  DiscontinuityMeshOptions options;
  options.irradiance_tolerance = tolerance * mean_on_floor(scene);
  options.max_length = 0.5;
  const Clock::time_point start = Clock::now();
  const OpaqueScene opaque(scene);
  const Discontinuities found = find_discontinuities(scene, opaque, light_sources(scene));
  row.find = seconds_since(start);
  const Clock::time_point meshing = Clock::now();
  const DiscontinuityMesh mesh = mesh_discontinuities(scene, found, options);
  row.mesh = seconds_since(meshing);
  row.megabytes = megabytes();
  row.silhouettes = found.report.silhouette_edges;
  row.swaths = found.report.swaths;
  row.found = found.report.found;
  row.merged = found.report.merged;
  row.curves = found.curves.size();
  row.kept = mesh.report.kept;
  row.culled = mesh.report.culled;
  row.elements = mesh.patches.element_count();
  return row;
}

/// In a process of its own; false if it did not come back.
bool measure_apart(char kind, int polygons, double tolerance, Row& row) {
  int ends[2];
  if (pipe(ends) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // do not outlive an interrupted parent
    const Row result = measure(kind, polygons, tolerance);
    const bool sent = write(ends[1], &result, sizeof result) == sizeof result;
    _exit(sent ? 0 : 1);
  }
  close(ends[1]);
  const bool received = read(ends[0], &row, sizeof row) == sizeof row;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return received;
}

void print_head() {
  std::printf(
      "| scene | polygons | silhouettes | swaths | contact | face | EV | EEE | merged | "
      "curves | kept | elements | find s | mesh s | MB |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
      "| --- |\n");
}

void print(char kind, const Row& r) {
  std::printf(
      "| %c | %d | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %d | %.2f | %.2f "
      "| %.0f |\n",
      kind, r.polygons, r.silhouettes, r.swaths, r.found[0], r.found[1], r.found[2], r.found[3],
      r.merged, r.curves, r.kept, r.elements, r.find, r.mesh, r.megabytes);
  std::fflush(stdout);
}

/// Exponent of the power law through the points, by least squares of the logarithms.
double exponent(const std::vector<std::pair<double, double>>& points) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(points.size());
  for (const auto& [a, b] : points) {
    x += std::log(a);
    y += std::log(b);
    xx += std::log(a) * std::log(a);
    xy += std::log(a) * std::log(b);
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void print_growth(char kind, const std::vector<Row>& rows) {
  const auto of = [&](const auto& value) {
    std::vector<std::pair<double, double>> points;
    for (const Row& row : rows) points.emplace_back(row.polygons, value(row));
    return exponent(points);
  };
  std::printf(
      "%c grows like polygons^e: curves e = %.2f, elements %.2f, time to find %.2f, time in "
      "all %.2f, memory %.2f\n",
      kind, of([](const Row& r) { return static_cast<double>(r.curves); }),
      of([](const Row& r) { return static_cast<double>(r.elements); }),
      of([](const Row& r) { return r.find; }), of([](const Row& r) { return r.find + r.mesh; }),
      of([](const Row& r) { return r.megabytes; }));
}

void all(double tolerance) {
  print_head();
  std::map<char, std::vector<Row>> rows;
  for (const char kind : {'A', 'B', 'K'})
    for (const int polygons : {100, 300, 600, 1000, 1500, 3000}) {
      // Adversarial: curves grow like the cube, and the next size takes over ten minutes.
      if (kind == 'K' && polygons > 100) continue;
      Row row;
      if (!measure_apart(kind, polygons, tolerance, row)) {
        std::printf("| %c | %d | did not finish |\n", kind, polygons);
        continue;
      }
      rows[kind].push_back(row);
      print(kind, row);
    }
  for (const auto& [kind, list] : rows)
    if (list.size() > 1) print_growth(kind, list);
}

}  // namespace
}  // namespace halfshade

int main(int argc, char** argv) {
  using namespace halfshade;
  if (argc < 3) {
    all(0.01);
    return 0;
  }
  print_head();
  print(argv[1][0], measure(argv[1][0], std::atoi(argv[2]), argc > 3 ? std::atof(argv[3]) : 0.01));
}
