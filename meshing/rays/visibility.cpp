#include "meshing/rays/visibility.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/rays/embree_scene.h"
#include "meshing/rays/scale_clusters.h"
#include "meshing/rays/shaft_index.h"

#include <fmt/core.h>

#include <algorithm>
#include <mutex>

namespace halfshade {
namespace {

constexpr std::size_t packet_size = EmbreeScene::packet_size;
constexpr std::size_t chunk_size = 1024;    // segments of one task; a multiple of packet_size
constexpr std::size_t serial_limit = 4096;  // batches up to this size are not worth a task
constexpr double largest_extent = 1e50;     // sixth powers of lengths occur
constexpr double same_distance = 1e-9;      // rounding, for rays that are not too grazing

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
  if (n == 0) return;
  Bounds box;
  for (const auto& corners : soup.triangles)
    for (const int v : corners) box.include(soup.points[at(v)]);
  const double half = (box.high / 2 - box.low / 2).maxCoeff();
  if (!(half < largest_extent) || (half > 0 && half < 1 / largest_extent))
    throw Error(ErrorCode::contract, "VisibilityIndex",
                fmt::format("the triangles extend over {}, out of range", 2 * half));
}

/// The lines that a packet's rays or segments lie on. Most of them go past small clusters.
class PacketLines {
 public:
  /// Of `count` of them, at least one.
  PacketLines(std::size_t count, const auto& origin, const auto& way) {
    for (std::size_t i = 0; i < packet_size; ++i) {
      const std::size_t k = i < count ? i : 0;
      origins_.row(static_cast<Eigen::Index>(i)) = origin(k).transpose();
      ways_.row(static_cast<Eigen::Index>(i)) = way(k).transpose();
    }
    squares_ = ways_.square().rowwise().sum();
  }

  /// Whether one of them, from its origin on, may meet what lies in a ball.
  bool may_meet(const Ball& ball) const {
    constexpr double rounding = 1e-12;
    const auto to_centre = (-origins_).rowwise() + ball.centre.transpose().array();
    const Lanes square = to_centre.square().rowwise().sum(),
                along = (to_centre * ways_).rowwise().sum(),
                reach = ball.radius * ball.radius + rounding * square;
    return (square <= reach ||
            (along > 0 && square * squares_ - along.square() <= reach * squares_))
        .any();
  }

 private:
  using Lanes = Eigen::Array<double, packet_size, 1>;

  Eigen::Array<double, packet_size, 3> origins_, ways_;
  Lanes squares_;
};

}  // namespace

struct VisibilityIndex::Impl {
  TriangleSoup soup;
  std::vector<EmbreeScene> scenes;  // of its clusters
  mutable std::once_flag planted;
  mutable std::optional<ShaftIndex> shafts;  // made by the first shaft query

  explicit Impl(TriangleSoup triangles) : soup(std::move(triangles)) {
    check(soup);
    for (const std::vector<int>& cluster : scale_clusters(soup)) scenes.emplace_back(soup, cluster);
  }

  /// Calls `look` with each scene that one of a packet's lines may meet.
  void visit(std::size_t count, const auto& origin, const auto& way, const auto& look) const {
    if (scenes.size() == 1) return look(scenes[0]);
    const PacketLines lines(count, origin, way);
    for (const EmbreeScene& scene : scenes)
      if (lines.may_meet(scene.ball())) look(scene);
  }

  /// Of segments of one packet.
  void look_along(std::span<const Segment> segments, std::span<std::uint8_t> result) const {
    visit(
        segments.size(), [&](std::size_t k) -> const Vec3& { return segments[k].from; },
        [&](std::size_t k) -> Vec3 { return segments[k].to - segments[k].from; },
        [&](const EmbreeScene& scene) { scene.blocked(segments, result); });
  }

  /// Where a ray that meets a triangle does so.
  Hit hit(const SoupTriangle& triangle, const HalfLine& ray) const {
    Hit hit;
    hit.owner = soup.owner[at(triangle.index)];
    hit.triangle = triangle.index;
    hit.distance = -triangle.height(ray.origin) / triangle.normal.dot(ray.direction);
    hit.weights = triangle.weights(ray.origin + hit.distance * ray.direction);
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
  return std::any_of(impl_->scenes.begin(), impl_->scenes.end(),
                     [&](const EmbreeScene& scene) { return scene.blocked(segment); });
}

void VisibilityIndex::blocked(std::span<const Segment> segments,
                              std::span<std::uint8_t> result) const {
  if (segments.size() != result.size())
    throw Error(ErrorCode::contract, "VisibilityIndex::blocked",
                fmt::format("{} segments and room for {} results", segments.size(), result.size()));
  std::fill(result.begin(), result.end(), std::uint8_t{0});
  const auto run = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; i += packet_size) {
      const std::size_t count = std::min(packet_size, end - i);
      impl_->look_along(segments.subspan(i, count), result.subspan(i, count));
    }
  };
  if (segments.size() <= serial_limit) return run(0, segments.size());
  parallel_for((segments.size() + chunk_size - 1) / chunk_size, [&](std::size_t chunk) {
    run(chunk * chunk_size, std::min((chunk + 1) * chunk_size, segments.size()));
  });
}

std::optional<Hit> VisibilityIndex::first_hit(const Vec3& origin, const Vec3& direction,
                                              Sides sides) const {
  if (!origin.allFinite() || !direction.allFinite()) return std::nullopt;
  const Vec3 unit = direction.stableNormalized();
  if (unit.isZero()) return std::nullopt;
  const HalfLine ray{origin, unit};
  std::optional<Hit> nearest;
  for (const EmbreeScene& scene : impl_->scenes) {
    const SoupTriangle* triangle = scene.first_hit(ray, sides);
    if (triangle == nullptr) continue;
    const Hit hit = impl_->hit(*triangle, ray);
    if (!nearest || hit.distance < nearest->distance) nearest = hit;
  }
  return nearest;
}

void VisibilityIndex::first_hits(std::span<const HalfLine> rays, Sides sides,
                                 std::span<Hit> hits) const {
  if (rays.size() != hits.size())
    throw Error(ErrorCode::contract, "VisibilityIndex::first_hits",
                fmt::format("{} rays and room for {} hits", rays.size(), hits.size()));
  std::fill(hits.begin(), hits.end(), Hit{-1, -1, 0, {}});
  std::array<const SoupTriangle*, packet_size> triangles;
  for (std::size_t i = 0; i < rays.size(); i += packet_size) {
    const auto packet = rays.subspan(i, std::min(packet_size, rays.size() - i));
    const auto look = [&](const EmbreeScene& scene) {
      scene.first_hits(packet, sides, std::span(triangles).first(packet.size()));
      for (std::size_t k = 0; k < packet.size(); ++k) {
        if (triangles[k] == nullptr) continue;
        const Hit hit = impl_->hit(*triangles[k], packet[k]);
        Hit& nearest = hits[i + k];
        if (nearest.triangle < 0 || hit.distance < nearest.distance) nearest = hit;
      }
    };
    impl_->visit(
        packet.size(), [&](std::size_t k) -> const Vec3& { return packet[k].origin; },
        [&](std::size_t k) -> const Vec3& { return packet[k].direction; }, look);
  }
}

std::optional<Hit> VisibilityIndex::facing_hit(const HalfLine& ray, const Hit& behind) const {
  const std::optional<Hit> front = first_hit(ray.origin, ray.direction, Sides::front_only);
  if (!front || front->distance > (1 + same_distance) * behind.distance) return std::nullopt;
  return front;
}

std::vector<int> VisibilityIndex::candidates(std::span<const Vec3> a,
                                             std::span<const Vec3> b) const {
  const Impl& impl = *impl_;
  if (a.empty() || b.empty())
    throw Error(ErrorCode::contract, "VisibilityIndex::candidates", "a polygon has no vertices");
  if (impl.soup.triangles.empty()) return {};
  std::call_once(impl.planted, [&] { impl.shafts.emplace(impl.soup); });
  return impl.shafts->candidates(a, b);
}

}  // namespace halfshade
