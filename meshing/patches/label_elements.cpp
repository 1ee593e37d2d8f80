#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/patches/curve_cells.h"
#include "meshing/patches/discontinuity_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace halfshade {
namespace {

// Elements a finder serves before another takes over.
constexpr std::size_t chunk = 256;
// Cells of so many are looked at more than once.
constexpr std::size_t large = 8;

void check(const SoundScene& scene, std::span<const LightSource> sources) {
  for (const LightSource& source : sources)
    if (source.surface < 0 || at(source.surface) >= scene.surfaces.size())
      throw Error(
          ErrorCode::contract, "label_elements",
          fmt::format("source {} is not among {} surfaces", source.surface, scene.surfaces.size()));
}

/// What elements see of sources, one thread's.
class Labeller {
 public:
  Labeller(const SoundScene& scene, const OpaqueScene& opaque, const ElementTable& elements)
      : scene_(scene), elements_(elements), finder_(opaque) {}

  Region look(int element, const LightSource& source) {
    return finder_.region(centre(element), elements_.normal[at(element)], source.surface);
  }

  /// The same for all elements of a cell; `label` takes the element and its region.
  template <class Label>
  void look_at_cell(std::span<const int> cell, const LightSource& source, const Label& label) {
    const Surface& emitter = scene_.surfaces[at(source.surface)];
    const double rounding = tolerance_of(emitter).length;
    in_front_.clear();
    for (const int e : cell)
      // The emitter's plane makes no curve, but what is behind it is known without a look.
      if (emitter.frame.height(centre(e)) > rounding)
        in_front_.push_back(e);
      else
        label(e, look(e, source));
    if (in_front_.empty()) return;
    const Region region = look(widest(), source);
    const bool is_one = agree(region, source);
    for (const int e : in_front_) label(e, is_one ? region : look(e, source));
  }

 private:
  Vec3 centre(int element) const {
    const auto [a, b, c] = elements_.triangle(element);
    return scene_.surfaces[at(elements_.surface[at(element)])].frame.foot((a + b + c) / 3);
  }

  /// The element in front whose centre is farthest from its edges, as elements beside bent curves
  /// may reach beyond them.
  int widest() const {
    const auto width = [&](int e) {
      const auto [a, b, c] = elements_.triangle(e);
      return elements_.area[at(e)] / ((b - a).norm() + (c - b).norm() + (a - c).norm());
    };
    return *std::max_element(in_front_.begin(), in_front_.end(),
                             [&](int a, int b) { return width(a) < width(b); });
  }

  /// Looks at some more of a large cell: a curve with a gap would make one of two.
  bool agree(Region region, const LightSource& source) {
    const std::size_t more = std::bit_width(in_front_.size() / large);
    for (std::size_t k = 0; k < more; ++k)
      if (look(in_front_[(2 * k + 1) * in_front_.size() / (2 * more)], source) != region)
        return false;
    return true;
  }

  const SoundScene& scene_;
  const ElementTable& elements_;
  VisiblePartFinder finder_;
  std::vector<int> in_front_;
};

}  // namespace

std::vector<Region> label_elements(const SoundScene& scene, const OpaqueScene& opaque,
                                   const ElementTable& elements,
                                   std::span<const LightSource> sources, const Progress& progress) {
  check(scene, sources);
  const std::size_t count = elements.corners.size();
  std::vector<Region> regions(count * sources.size(), Region::away);
  const auto label = [&](std::size_t first) {
    Labeller labeller(scene, opaque, elements);
    for (std::size_t e = first; e < std::min(first + chunk, count); ++e)
      for (std::size_t s = 0; s < sources.size(); ++s)
        regions[e * sources.size() + s] = labeller.look(static_cast<int>(e), sources[s]);
  };
  parallel_for((count + chunk - 1) / chunk, [&](std::size_t i) { label(chunk * i); }, progress,
               "regions");
  return regions;
}

std::vector<Region> label_cells(const SoundScene& scene, const OpaqueScene& opaque,
                                const ElementTable& elements, std::span<const LightSource> sources,
                                const Progress& progress) {
  check(scene, sources);
  std::vector<Region> regions(elements.corners.size() * sources.size(), Region::away);
  const CurveCells cells = curve_cells(elements);
  // Ranges of cells with about as many elements each.
  std::vector<std::size_t> begin = {0};
  for (std::size_t c = 1; c < cells.count(); ++c)
    if (at(cells.first[c] - cells.first[begin.back()]) >= chunk) begin.push_back(c);
  begin.push_back(cells.count());
  const auto label = [&](std::size_t i) {
    Labeller labeller(scene, opaque, elements);
    for (std::size_t c = begin[i]; c < begin[i + 1]; ++c)
      for (std::size_t s = 0; s < sources.size(); ++s)
        labeller.look_at_cell(cells.of(c), sources[s], [&](int e, Region region) {
          regions[at(e) * sources.size() + s] = region;
        });
  };
  parallel_for(begin.size() - 1, label, progress, "regions");
  return regions;
}

}  // namespace halfshade
