#include "meshing/backprojection/opaque_topology.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace halfshade {

void connect_triangles(OpaqueTopology& out) {
  struct Use {
    int from, to, triangle, side, direction;
  };
  std::vector<Use> uses;
  for (std::size_t t = 0; t < out.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = out.triangles[t].corner[at(k)], b = out.triangles[t].corner[at((k + 1) % 3)];
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), k, a < b ? 1 : -1});
    }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return std::tie(a.from, a.to, a.triangle, a.side) < std::tie(b.from, b.to, b.triangle, b.side);
  });
  for (const Use& use : uses) {
    if (out.edges.empty() || out.edges.back().from != use.from || out.edges.back().to != use.to)
      out.edges.push_back({use.from, use.to, static_cast<int>(out.incidences.size()), 0, HUGE_VAL});
    const double length =
        out.surfaces[at(out.triangles[at(use.triangle)].surface)].tolerance.length;
    out.edges.back().joined = std::min(out.edges.back().joined, length);
    ++out.edges.back().count;
    out.incidences.push_back({use.triangle, use.direction});
    out.triangles[at(use.triangle)].edge[at(use.side)] = static_cast<int>(out.edges.size()) - 1;
  }
}

OpaqueTopology make_opaque_topology(const SoundScene& scene) {
  OpaqueTopology topology;
  join_outlines(scene, topology);
  cut_into_triangles(scene, topology);
  connect_triangles(topology);
  return topology;
}

}  // namespace halfshade
