#include "meshing/rays/visibility.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/rays/embree_scene.h"
#include "meshing/rays/shaft_index.h"

#include <fmt/core.h>

#include <algorithm>
#include <mutex>

namespace halfshade {
namespace {

constexpr std::size_t packet_size = EmbreeScene::packet_size;
constexpr std::size_t chunk_size = 1024;    // segments of one task; a multiple of packet_size
constexpr std::size_t serial_limit = 4096;  // batches up to this size are not worth a task

void check(const TriangleSoup& soup) {
  const std::size_t n = soup.triangles.size();
  if (soup.owner.size() != n || soup.plane.size() != n)
    throw Error(ErrorCode::contract, "VisibilityIndex",
                fmt::format("{} triangles have {} owners and {} planes", n, soup.owner.size(),
                            soup.plane.size()));
  for (std::size_t t = 0; t < n; ++t)
    for (const int v : soup.triangles[t]) {
      if (v < 0 || static_cast<std::size_t>(v) >= soup.points.size())
        throw Error(ErrorCode::contract, "VisibilityIndex",
                    fmt::format("triangle {} has corner {} of {}", t, v, soup.points.size()));
      if (!soup.points[static_cast<std::size_t>(v)].allFinite())
        throw Error(ErrorCode::contract, "VisibilityIndex",
                    fmt::format("point {} is not finite", v));
    }
}

}  // namespace

struct VisibilityIndex::Impl {
  TriangleSoup soup;
  RaySpace space;
  std::optional<EmbreeScene> scene;  // if there are triangles
  mutable std::once_flag planted;
  mutable std::optional<ShaftIndex> shafts;  // made by the first shaft query

  explicit Impl(TriangleSoup triangles) : soup(std::move(triangles)) {
    check(soup);
    space = make_ray_space(soup);
    if (!soup.triangles.empty()) scene.emplace(soup, space);
  }

  /// Where a ray that meets a triangle does so.
  Hit hit(const Vec3& origin, const Vec3& direction, int triangle) const {
    const SoupTriangle& corners = scene->triangle(triangle);
    Hit hit;
    hit.owner = soup.owner[at(triangle)];
    hit.triangle = triangle;
    hit.distance = -corners.height(origin) / corners.normal.dot(direction);
    hit.weights = corners.weights(origin + hit.distance * direction);
    return hit;
  }
};

VisibilityIndex::VisibilityIndex(TriangleSoup soup)
    : impl_(std::make_unique<Impl>(std::move(soup))) {}
VisibilityIndex::~VisibilityIndex() = default;
VisibilityIndex::VisibilityIndex(VisibilityIndex&&) noexcept = default;
VisibilityIndex& VisibilityIndex::operator=(VisibilityIndex&&) noexcept = default;

const TriangleSoup& VisibilityIndex::soup() const { return impl_->soup; }

bool VisibilityIndex::blocked(const Segment& segment) const {
  return impl_->scene && impl_->scene->blocked(segment);
}

void VisibilityIndex::blocked(std::span<const Segment> segments,
                              std::span<std::uint8_t> result) const {
  if (segments.size() != result.size())
    throw Error(ErrorCode::contract, "VisibilityIndex::blocked",
                fmt::format("{} segments and room for {} results", segments.size(), result.size()));
  if (!impl_->scene) {
    std::fill(result.begin(), result.end(), std::uint8_t{0});
    return;
  }
  const auto run = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; i += packet_size) {
      const std::size_t count = std::min(packet_size, end - i);
      impl_->scene->blocked(segments.subspan(i, count), result.subspan(i, count));
    }
  };
  if (segments.size() <= serial_limit) return run(0, segments.size());
  parallel_for((segments.size() + chunk_size - 1) / chunk_size, [&](std::size_t chunk) {
    run(chunk * chunk_size, std::min((chunk + 1) * chunk_size, segments.size()));
  });
}

std::optional<Hit> VisibilityIndex::first_hit(const Vec3& origin, const Vec3& direction,
                                              Sides sides) const {
  if (!impl_->scene || !origin.allFinite() || !direction.allFinite()) return std::nullopt;
  const Vec3 unit = direction.stableNormalized();
  if (unit.isZero()) return std::nullopt;
  const int triangle = impl_->scene->first_hit({origin, unit}, sides);
  if (triangle < 0) return std::nullopt;
  return impl_->hit(origin, unit, triangle);
}

void VisibilityIndex::first_hits(std::span<const HalfLine> rays, Sides sides,
                                 std::span<Hit> hits) const {
  if (rays.size() != hits.size())
    throw Error(ErrorCode::contract, "VisibilityIndex::first_hits",
                fmt::format("{} rays and room for {} hits", rays.size(), hits.size()));
  std::array<int, packet_size> triangles;
  for (std::size_t i = 0; i < rays.size(); i += packet_size) {
    const auto packet = rays.subspan(i, std::min(packet_size, rays.size() - i));
    triangles.fill(-1);
    if (impl_->scene)
      impl_->scene->first_hits(packet, sides, std::span(triangles).first(packet.size()));
    for (std::size_t k = 0; k < packet.size(); ++k)
      hits[i + k] = triangles[k] < 0
                        ? Hit{-1, -1, 0, {}}
                        : impl_->hit(packet[k].origin, packet[k].direction, triangles[k]);
  }
}

std::vector<int> VisibilityIndex::candidates(std::span<const Vec3> a,
                                             std::span<const Vec3> b) const {
  const Impl& impl = *impl_;
  if (a.empty() || b.empty())
    throw Error(ErrorCode::contract, "VisibilityIndex::candidates", "a polygon has no vertices");
  if (!impl.scene) return {};
  std::call_once(impl.planted, [&] { impl.shafts.emplace(impl.soup); });
  return impl.shafts->candidates(a, b);
}

}  // namespace halfshade
