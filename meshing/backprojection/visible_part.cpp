#include "meshing/backprojection/visible_part.h"

#include "meshing/backprojection/margins.h"
#include "meshing/backprojection/part_search.h"
#include "meshing/backprojection/sight_candidates.h"
#include "meshing/backprojection/sight_shaft.h"
#include "meshing/backprojection/visible_cells.h"
#include "meshing/core/error.h"
#include "meshing/geometry/spread_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

void check(const OpaqueTopology& topology, const Vec3& point, const Vec3& normal, int surface) {
  if (surface < 0 || static_cast<std::size_t>(surface) >= topology.surfaces.size())
    throw Error(ErrorCode::contract, "VisiblePartFinder",
                fmt::format("there is no surface {} among {}", surface, topology.surfaces.size()));
  if (!point.allFinite() || !(std::abs(normal.squaredNorm() - 1) < margins::unit_length))
    throw Error(ErrorCode::contract, "VisiblePartFinder",
                fmt::format("the point ({}, {}, {}) must be finite and its normal ({}, {}, {}) of "
                            "length 1",
                            point.x(), point.y(), point.z(), normal.x(), normal.y(), normal.z()));
}

/// Directions that tell penumbra; where they agree, they hardly ever tell more.
constexpr std::size_t tried_directions = 8;

}  // namespace

struct VisiblePartFinder::Impl {
  explicit Impl(const OpaqueScene& scene) : scene(scene), search(scene), cells(search) {
    everything = all_candidates(scene.face_tree());
  }
  bool is_surely_penumbra(const Vec3& point, const Vec3& normal, int surface);

  const OpaqueScene& scene;
  PartSearch search;
  VisibleCells cells;
  SightCandidates everything;
  SightShaft shaft;
  CandidateSearch candidate_search;
  VisiblePart part;  ///< of which only the region is asked for

  bool find(const Vec3& point, const Vec3& normal, int surface, const SightCandidates* candidates,
            bool unless_crowded, VisiblePart& part);
};

bool VisiblePartFinder::Impl::find(const Vec3& point, const Vec3& normal, int surface,
                                   const SightCandidates* candidates, bool unless_crowded,
                                   VisiblePart& part) {
  PointView& view = search.view;
  check(view.topology(), point, normal, surface);
  clear(part);
  double jitter = 0;
  for (int attempt = 0; attempt < margins::most_attempts; ++attempt) {
    view.start(point, normal, surface, jitter);
    // Scattered corners may leave the boxes that were looked through.
    if (candidates != nullptr && jitter == 0) view.narrow_to(*candidates);
    if (!(view.distance() > view.slack()) || !search.outline.make(view, point, normal, surface))
      return true;
    const PartSearch::End end = search.arrange(unless_crowded);
    if (end == PartSearch::End::crowded) return false;
    if (end == PartSearch::End::found) break;
    jitter = next_jitter(jitter);
  }
  search.write(part);
  return true;
}

/// Some direction shows the emitter and another one does not.
bool VisiblePartFinder::Impl::is_surely_penumbra(const Vec3& point, const Vec3& normal,
                                                 int surface) {
  PointView& view = search.view;
  check(view.topology(), point, normal, surface);
  view.start(point, normal, surface);
  if (!(view.distance() > view.slack()) || !search.outline.make(view, point, normal, surface))
    return false;
  const auto& triangles = cells.triangles_of(surface);
  const std::vector<Vec3>& vertices = view.topology().vertices;
  SpreadPairs pairs(0);
  bool is_seen = false, is_hidden = false;
  for (std::size_t k = 0; k < tried_directions && !triangles.empty() && !(is_seen && is_hidden);
       ++k) {
    const auto& [a, b, c] = triangles[k % triangles.size()];
    const auto [s, t] = pairs.next();
    const Vec3 direction =
        point_of({vertices[at(a)], vertices[at(b)], vertices[at(c)]}, s, t) - point;
    if (!(normal.dot(direction) > margins::clearly_inside * direction.norm())) continue;
    const ClearSight sight = view.clear_sight(direction);
    is_seen = is_seen || sight == ClearSight::seen;
    is_hidden = is_hidden || sight == ClearSight::hidden;
  }
  return is_seen && is_hidden;
}

VisiblePartFinder::VisiblePartFinder(const OpaqueScene& scene)
    : impl_(std::make_unique<Impl>(scene)) {}

VisiblePartFinder::~VisiblePartFinder() = default;
VisiblePartFinder::VisiblePartFinder(VisiblePartFinder&&) noexcept = default;
VisiblePartFinder& VisiblePartFinder::operator=(VisiblePartFinder&&) noexcept = default;

void VisiblePartFinder::find(const Vec3& point, const Vec3& normal, int surface,
                             VisiblePart& part) {
  impl_->find(point, normal, surface, nullptr, false, part);
}

Region VisiblePartFinder::region(const Vec3& point, const Vec3& normal, int surface) {
  if (impl_->is_surely_penumbra(point, normal, surface)) return Region::penumbra;
  impl_->find(point, normal, surface, nullptr, false, impl_->part);
  return impl_->part.region;
}

bool VisiblePartFinder::find_unless_crowded(const Vec3& point, const Vec3& normal, int surface,
                                            VisiblePart& part) {
  return impl_->find(point, normal, surface, nullptr, true, part);
}

bool VisiblePartFinder::find_unless_crowded(const Vec3& point, const Vec3& normal, int surface,
                                            const SightCandidates& candidates, VisiblePart& part) {
  return impl_->find(point, normal, surface, &candidates, true, part);
}

void VisiblePartFinder::find_candidates(std::span<const Vec3> points, int surface,
                                        const SightCandidates* among, SightCandidates& found) {
  const OpaqueTopology& topology = impl_->scene.topology();
  impl_->shaft.make(topology.surfaces[at(surface)],
                    impl_->search.outline.lines_of(topology, surface), points);
  impl_->candidate_search.narrow(impl_->scene.face_tree(), impl_->shaft,
                                 among != nullptr ? *among : impl_->everything, found);
}

std::size_t VisiblePartFinder::find_in_cells(const Vec3& point, const Vec3& normal, int surface,
                                             VisiblePart& part,
                                             const std::function<void(const VisiblePart&)>& use) {
  check(impl_->search.view.topology(), point, normal, surface);
  return impl_->cells.run(point, normal, surface, part, use);
}

const SightEffort& VisiblePartFinder::effort() const { return impl_->search.view.effort(); }

std::vector<std::vector<Vec3>> visible_rings(const VisiblePart& part, const Vec3& point,
                                             const PlaneFrame& emitter) {
  const double distance = emitter.height(point);
  std::vector<std::vector<Vec3>> rings;
  int first = 0;
  for (const int end : part.chain_ends) {
    rings.emplace_back();
    for (int i = first; i < end; ++i) {
      const Vec3 direction = part.pieces[static_cast<std::size_t>(i)].from - point;
      rings.back().push_back(point - distance / emitter.normal.dot(direction) * direction);
    }
    first = end;
  }
  return rings;
}

}  // namespace halfshade
