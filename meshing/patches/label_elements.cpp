#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/patches/discontinuity_mesh.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

// Elements a finder serves before another takes over.
constexpr std::size_t chunk = 256;

}  // namespace

std::vector<Region> label_elements(const SoundScene& scene, const OpaqueScene& opaque,
                                   const ElementTable& elements,
                                   std::span<const LightSource> sources, const Progress& progress) {
  for (const LightSource& source : sources)
    if (source.surface < 0 || at(source.surface) >= scene.surfaces.size())
      throw Error(
          ErrorCode::contract, "label_elements",
          fmt::format("source {} is not among {} surfaces", source.surface, scene.surfaces.size()));
  const std::size_t count = elements.corners.size();
  std::vector<Region> regions(count * sources.size(), Region::away);
  const auto label = [&](std::size_t first) {
    VisiblePartFinder finder(opaque);
    VisiblePart part;
    for (std::size_t e = first; e < std::min(first + chunk, count); ++e) {
      const auto [a, b, c] = elements.triangle(static_cast<int>(e));
      for (std::size_t s = 0; s < sources.size(); ++s) {
        finder.find((a + b + c) / 3, elements.normal[e], sources[s].surface, part);
        regions[e * sources.size() + s] = part.region;
      }
    }
  };
  parallel_for((count + chunk - 1) / chunk, [&](std::size_t i) { label(chunk * i); }, progress,
               "regions");
  return regions;
}

}  // namespace halfshade
