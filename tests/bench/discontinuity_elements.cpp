#include "meshing/core/light_source.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "solver/direct/direct_light.h"
#include "tests/support/discontinuity_scenes.h"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>

// How many elements of order 2 it takes until the direct irradiance of the floor, interpolated at
// six nodes, is right to 1 % (of its maximum) everywhere in the penumbra: with and without mesh
// edges along the discontinuity curves. Elements that are not good enough are split in four.
//   halfshade_elements [share]

namespace halfshade {
namespace {

constexpr int rows_of_samples = 12;  // on an element's side
constexpr int most_rounds = 14;

/// The floor of a scene and the light on it.
struct Floor {
  const SoundScene& scene;
  const DirectLightIndex index;
  int surface = 0;

  explicit Floor(const SoundScene& s) : scene(s), index(s) {
    for (int r = 0; r < static_cast<int>(s.surfaces.size()); ++r)
      if (const PlaneFrame& f = s.surfaces[static_cast<std::size_t>(r)].frame;
          f.normal.z() > 0.5 && std::abs(f.origin.z()) < 1e-12)
        surface = r;
  }
  DirectLight at(const Vec3& p) const { return index.irradiance(SurfacePoint{p, Vec3::UnitZ()}); }
};

struct Judged {
  double error = 0;  ///< the largest, of samples in the penumbra
  double largest = 0;
  bool in_penumbra = false;
};

Judged judge(const Floor& floor, const std::array<Vec3, 3>& t) {
  std::array<double, 6> node{};
  const std::array<Vec3, 6> place = {
      t[0], t[1], t[2], 0.5 * (t[0] + t[1]), 0.5 * (t[1] + t[2]), 0.5 * (t[2] + t[0])};
  for (std::size_t k = 0; k < 6; ++k) node[k] = floor.at(place[k]).irradiance[0];
  Judged result;
  for (int i = 0; i <= rows_of_samples; ++i)
    for (int j = 0; j <= rows_of_samples - i; ++j) {
      // A little inside, so that it is clear which side of a curve counts.
      constexpr double inwards = 1e-6;
      const double u = inwards + (1 - 3 * inwards) * i / rows_of_samples;
      const double v = inwards + (1 - 3 * inwards) * j / rows_of_samples;
      const double w = 1 - u - v;
      const DirectLight light = floor.at(u * t[0] + v * t[1] + w * t[2]);
      result.largest = std::max(result.largest, light.irradiance[0]);
      if (light.region != Region::penumbra) continue;
      result.in_penumbra = true;
      const double value = node[0] * u * (2 * u - 1) + node[1] * v * (2 * v - 1) +
                           node[2] * w * (2 * w - 1) + 4 * node[3] * u * v + 4 * node[4] * v * w +
                           4 * node[5] * w * u;
      result.error = std::max(result.error, std::abs(value - light.irradiance[0]));
    }
  return result;
}

struct Count {
  int all = 0, penumbra = 0;  ///< elements of the floor
  double error = 0;           ///< share of the maximum
  int first = 0;              ///< before any was split
};

Count refine(const Floor& floor, PatchMesh& mesh, double share) {
  std::map<int, Judged> judged;  // hierarchy node → what came out
  Count count;
  for (int round = 0;; ++round) {
    const ElementTable elements = mesh.elements();
    const PatchHierarchy hierarchy = mesh.hierarchy();
    std::vector<std::pair<int, Judged>> here;
    double largest = 0;
    for (int node = 0; node < static_cast<int>(hierarchy.element.size()); ++node) {
      const int e = hierarchy.element[static_cast<std::size_t>(node)];
      if (e < 0 || elements.surface[static_cast<std::size_t>(e)] != floor.surface) continue;
      const auto found = judged.find(node);
      const Judged& j =
          found != judged.end()
              ? found->second
              : judged.emplace(node, judge(floor, elements.triangle(e))).first->second;
      here.emplace_back(e, j);
      largest = std::max(largest, j.largest);
    }
    std::vector<int> bad;
    count = {static_cast<int>(here.size()), 0, 0,
             round == 0 ? static_cast<int>(here.size()) : count.first};
    for (const auto& [e, j] : here) {
      count.penumbra += j.in_penumbra ? 1 : 0;
      count.error = std::max(count.error, j.error / largest);
      if (j.error > share * largest) bad.push_back(e);
    }
    if (bad.empty() || round == most_rounds) return count;
    std::sort(bad.begin(), bad.end());
    mesh.split_in_four(bad);
  }
}

void print(const char* scene, const char* how, const Count& c) {
  std::printf("| %s | %s | %d | %d | %d | %.2f |\n", scene, how, c.first, c.all, c.penumbra,
              100 * c.error);
  std::fflush(stdout);
}

void compare(const char* name, const SoundScene& scene, double share) {
  const Floor floor(scene);
  PatchMesh plain(scene, PlanarMeshOptions{.max_length = 1});
  print(name, "without lines", refine(floor, plain, share));
  const OpaqueScene opaque(scene);
  const Discontinuities found = find_discontinuities(scene, opaque, light_sources(scene));
  DiscontinuityMesh complete = mesh_discontinuities(scene, found, {});
  print(name, "with all lines", refine(floor, complete.patches, share));
  const double largest = floor.at({1.5, 1.3, 0}).irradiance[0];
  DiscontinuityMesh culled = mesh_discontinuities(
      scene, found, {.max_length = 1, .irradiance_tolerance = share * largest});
  print(name, "with lines that matter", refine(floor, culled.patches, share));
}

}  // namespace
}  // namespace halfshade

int main(int argc, char** argv) {
  using namespace halfshade;
  const double share = argc > 1 ? std::atof(argv[1]) : 0.01;
  std::printf(
      "| scene | mesh | elements at first | in the end | of them in the penumbra | largest "
      "error %% |\n| --- | --- | --- | --- | --- | --- |\n");
  compare("S1", test::s1(), share);
  compare("bars", test::bars(8), share);
  compare("skew bars", test::skew_bars_maker().sound(), share);
}
