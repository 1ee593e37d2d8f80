#include "solver/factors/factor_matrix.h"
#include "tests/support/balls.h"
#include "tests/support/round_things.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

// How long matrices of form factors take, how that grows, and what rays make of the same.
//   halfshade_matrices                    both families, as far as a few minutes go
//   halfshade_matrices nested 25 1e-4     a box in a box of 12 n² faces (n = 25: 7,500)
//   halfshade_matrices boxes 5 1e-4       k³ boxes in a room of 6 (k + 3)² faces (k = 5: 1,134)
//   halfshade_matrices boxes 5 1e-4 exact the same without rays
//   halfshade_matrices boxes 5 1e-4 material
//                                         the same between all boxes and the room
//   halfshade_matrices balls 3 1e-4 material
//                                         two balls of 20 · 4³ facets in a room, and the room
//   halfshade_matrices round 24 1e-4 material
//                                         cylinders of 24 faces, a ball and a box in a room
// CPU time is that of all threads. The row error is the largest |row sum − 1| of a closed scene;
// that of rays the largest root of the sum of squares of what a row's entries differ by from the
// exact ones. Rays to the exact method's are extrapolated from that, for it falls like the root of
// their number.

namespace halfshade {
namespace {

constexpr int rays_a_row = 4096;

/// A parallelogram of n × n faces, counter-clockwise seen from where u × v points.
void add_side(Scene& scene, const Vec3& corner, const Vec3& u, const Vec3& v, int n) {
  const int first = static_cast<int>(scene.vertices.size());
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) scene.vertices.push_back(corner + i * u / n + j * v / n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int at = first + j * (n + 1) + i;
      Face face;
      face.vertices = {at, at + 1, at + n + 2, at + n + 1};
      face.material = static_cast<int>(scene.materials.size()) - 1;
      scene.faces.push_back(std::move(face));
    }
}

/// A cube whose faces look outwards, or inwards.
void add_cube(Scene& scene, const Vec3& low, double size, int n, bool outwards) {
  const std::array<Vec3, 3> e = {Vec3(size, 0, 0), Vec3(0, size, 0), Vec3(0, 0, size)};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &u = e[(k + 1) % 3], &v = e[(k + 2) % 3];
    add_side(scene, low, outwards ? v : u, outwards ? u : v, n);
    add_side(scene, low + e[k], outwards ? u : v, outwards ? v : u, n);
  }
}

Scene empty_scene() {
  Scene scene;
  scene.materials.emplace_back();
  scene.groups.emplace_back("all");
  return scene;
}

Scene nested(int n) {
  Scene scene = empty_scene();
  add_cube(scene, Vec3::Zero(), 3, n, false);
  add_cube(scene, Vec3::Ones(), 1, n, true);
  return scene;
}

Scene boxes(int k) {
  Scene scene = empty_scene();
  add_cube(scene, Vec3::Zero(), k + 1, k + 3, false);
  scene.materials.emplace_back();
  for (int x = 0; x < k; ++x)
    for (int y = 0; y < k; ++y)
      for (int z = 0; z < k; ++z) add_cube(scene, Vec3(x + .8, y + .8, z + .8), .4, 1, true);
  return scene;
}

struct Run {
  FactorMatrix matrix;
  double cpu = 0;
};

Run run(const Scene& scene, const FactorOptions& options) {
  const std::clock_t start = std::clock();
  Run result{form_factor_matrix(scene, options), 0};
  result.cpu = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return result;
}

double row_error(const FactorMatrix& a, const FactorMatrix& b) {
  return (a.factors - b.factors).rowwise().norm().maxCoeff();
}

struct Last {
  double faces = 0, cpu = 0;
};

void print_exact(const std::string& name, const Scene& scene, double tolerance, FactorUnit unit) {
  FactorOptions options;
  options.unit = unit;
  options.method = FactorMethod::exact;
  options.tolerance = tolerance;
  const Run exact = run(scene, options);
  const FactorReport& report = exact.matrix.report;
  std::printf("%-7s %6zu %8.0e %10.1e %9.1f %9s %9zu %9zu %9.0f\n", name.c_str(),
              scene.faces.size(), tolerance, report.row_sum_error_max, exact.cpu, "",
              report.clear_pairs, report.partial_pairs,
              static_cast<double>(report.points) /
                  static_cast<double>(std::max<std::size_t>(report.partial_pairs, 1)));
}

void print(const std::string& name, const Scene& scene, double tolerance, Last& last) {
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.method = FactorMethod::exact;
  options.tolerance = tolerance;
  const Run exact = run(scene, options);
  options.method = FactorMethod::rays;
  options.rays = rays_a_row;
  const Run rays = run(scene, options);
  const FactorReport& report = exact.matrix.report;
  const double faces = static_cast<double>(scene.faces.size());
  const double of_rays = row_error(rays.matrix, exact.matrix);
  const double as_exact = rays.cpu * std::pow(of_rays / report.row_sum_error_max, 2);
  const double exponent =
      last.cpu > 0 ? std::log(exact.cpu / last.cpu) / std::log(faces / last.faces) : 0;
  std::printf("%-7s %6.0f %8.0e %10.1e %9.1f %9.2f %9zu %9zu %9.0f %10.1e %9.1f %11.0f\n",
              name.c_str(), faces, tolerance, report.row_sum_error_max, exact.cpu, exponent,
              report.clear_pairs, report.partial_pairs,
              static_cast<double>(report.points) /
                  static_cast<double>(std::max<std::size_t>(report.partial_pairs, 1)),
              of_rays, rays.cpu, as_exact);
  std::fflush(stdout);
  last = {faces, exact.cpu};
}

Scene scene_of(const std::string& name, int size) {
  if (name == "balls") return test::room_with_balls(2, size);
  if (name == "round") return test::room_with_round_things(size);
  return name == "nested" ? nested(size) : boxes(size);
}

void print_family(const std::string& name, const std::vector<int>& sizes, double tolerance) {
  Last last;
  for (const int size : sizes) print(name, scene_of(name, size), tolerance, last);
}

}  // namespace
}  // namespace halfshade

int main(int count, char** words) {
  std::printf("%-7s %6s %8s %10s %9s %9s %9s %9s %9s %10s %9s %11s\n", "scene", "faces", "asked",
              "row error", "CPU s", "growth", "clear", "partial", "points", "rays' row", "their s",
              "s as exact");
  if (count == 5) {
    halfshade::print_exact(words[1], halfshade::scene_of(words[1], std::atoi(words[2])),
                           std::atof(words[3]),
                           std::string(words[4]) == "material" ? halfshade::FactorUnit::material
                                                               : halfshade::FactorUnit::face);
    return 0;
  }
  if (count == 4) {
    halfshade::print_family(words[1], {std::atoi(words[2])}, std::atof(words[3]));
    return 0;
  }
  for (const double tolerance : {1e-3, 1e-4}) {
    halfshade::print_family("nested", {2, 4, 8}, tolerance);
    halfshade::print_family("boxes", {1, 2}, tolerance);
  }
}
