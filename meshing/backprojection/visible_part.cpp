#include "meshing/backprojection/visible_part.h"

#include "meshing/backprojection/boundary_chains.h"
#include "meshing/backprojection/margins.h"
#include "meshing/backprojection/shadow_arrangement.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

// Any fixed numbers.
constexpr std::uint64_t lit_signature = 0x9d5c31a4e8f07b63;
constexpr std::uint64_t umbra_signature = 0x3fb86a2c90d7154e;
constexpr std::uint64_t away_signature = 0x71e40b9d256c8fa3;

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

void clear(VisiblePart& part) {
  part.region = Region::away;
  part.signature = away_signature;
  part.pieces.clear();
  part.chain_ends.clear();
  part.unobstructed.clear();
}

}  // namespace

struct VisiblePartFinder::Impl {
  explicit Impl(const OpaqueScene& scene) : view(scene) {}

  PointView view;
  EmitterOutline outline;
  ShadowArrangement arrangement;
  BoundaryChains chains;

  /// False if nothing of the emitter is in front and above the horizon.
  bool try_with(double jitter, const Vec3& point, const Vec3& normal, int surface);
  void fill_unobstructed(VisiblePart& part) const;
};

bool VisiblePartFinder::Impl::try_with(double jitter, const Vec3& point, const Vec3& normal,
                                       int surface) {
  view.start(point, normal, surface, jitter);
  if (!(view.distance() > view.slack()) || !outline.make(view, point, normal, surface))
    return false;
  arrangement.build(view, outline);
  chains.link(arrangement, view);
  return true;
}

void VisiblePartFinder::Impl::fill_unobstructed(VisiblePart& part) const {
  for (const OutlineEdge& edge : outline.edges)
    part.unobstructed.push_back({view.corners[static_cast<std::size_t>(edge.from)].true_position,
                                 view.corners[static_cast<std::size_t>(edge.to)].true_position,
                                 edge.edge});
}

VisiblePartFinder::VisiblePartFinder(const OpaqueScene& scene)
    : impl_(std::make_unique<Impl>(scene)) {}

VisiblePartFinder::~VisiblePartFinder() = default;
VisiblePartFinder::VisiblePartFinder(VisiblePartFinder&&) noexcept = default;
VisiblePartFinder& VisiblePartFinder::operator=(VisiblePartFinder&&) noexcept = default;

void VisiblePartFinder::find(const Vec3& point, const Vec3& normal, int surface,
                             VisiblePart& part) {
  Impl& m = *impl_;
  check(m.view.topology(), point, normal, surface);
  clear(part);
  double jitter = 0;
  for (int attempt = 0; attempt < margins::most_attempts; ++attempt) {
    if (!m.try_with(jitter, point, normal, surface)) return;
    if (m.arrangement.is_consistent && m.chains.closed) break;
    jitter = std::max(margins::jitter_growth * jitter, margins::least_jitter);
  }
  m.fill_unobstructed(part);
  if (m.arrangement.fully_lit || (!m.chains.pieces.empty() && m.chains.fill(m.outline, m.view))) {
    part.region = Region::lit;
    part.signature = lit_signature;
    part.pieces = part.unobstructed;
    m.outline.copy_ends(part.chain_ends);
  } else if (m.chains.pieces.empty()) {
    part.region = Region::umbra;
    part.signature = umbra_signature;
  } else {
    part.region = Region::penumbra;
    part.signature = m.chains.signature;
    m.chains.copy(part);
  }
}

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
