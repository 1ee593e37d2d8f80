#include "meshing/rays/visibility.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/rays/soup_triangle.h"
#include "meshing/rays/triangle_tree.h"

#include <Eigen/Geometry>
#include <embree3/rtcore.h>
#include <fmt/core.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <type_traits>

// Embree collects, the filters decide. Embree sees every triangle a little enlarged and every ray a
// little lengthened, by more than the rounding of single precision, and hands each triangle it
// finds to a filter, which tests the true triangle in double precision. So rays may start and end
// on triangles at any angle, nothing slips through at shared edges and corners (Embree's robust
// mode alone lets one in a thousand rays aimed at a vertex through), and false hits far along a
// skinny triangle's plane do no harm.

namespace halfshade {
namespace {

constexpr std::size_t packet_size = 16;     // lanes of an Embree packet
constexpr std::size_t chunk_size = 1024;    // segments of one task; a multiple of packet_size
constexpr std::size_t serial_limit = 4096;  // batches up to this size are not worth a task

// Embree's coordinates lie in [−1, 1], and a line through a triangle there is off by about ten
// roundings, 2^-20. Edges are moved outwards by four times that, and rays, whose ends suffer more
// at grazing angles, lengthened by much more. Corners move by at most miter_limit times as much.
constexpr double enlargement = 0x1p-18;
constexpr double lengthening = 0x1p-12;
constexpr double miter_limit = 64;

// Relative to the scene's size: a point this close to a triangle's plane lies in it, and a line
// this close to its border meets it. Points that were computed to lie there do so within about
// 1e-15.
constexpr double in_plane_distance = 1e-10;
constexpr double on_border_distance = 1e-12;
constexpr double in_shaft_distance = 1e-12;

// A packet whose origins and ends lie this close together is traced as one bundle, else ray by ray:
// measured, either is up to three times as fast as the other beyond this.
constexpr double bundle_spread = 0.2;

constexpr double largest_extent = 1e30;  // sixth powers of lengths occur

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceRelease>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;

void throw_on_error(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorCode::too_large, "VisibilityIndex", "not enough memory for the triangles");
  throw Error(ErrorCode::contract, "VisibilityIndex",
              fmt::format("Embree failed with error {}", static_cast<int>(error)));
}

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

/// A ray in Embree's coordinates.
struct Ray {
  Vec3 origin;
  Vec3 direction;  // unit length
  double length = 0;

  Vec3 end() const { return origin + length * direction; }
};

/// Cuts a ray to the cube that holds all triangles, so that far end points cost no precision.
/// False if nothing is left.
bool clip_to_cube(Ray& ray) {
  const double half = 1 + 2 * lengthening;
  double enter = 0, leave = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) {
      if (std::abs(o) > half) return false;
      continue;
    }
    const double t0 = (-half - o) / d, t1 = (half - o) / d;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (!(enter <= leave)) return false;
  ray.origin += enter * ray.direction;
  ray.length = leave - enter;
  return true;
}

/// What the filters need to know of a query; Embree hands the context through to them.
struct Query {
  RTCIntersectContext context;
  const TriangleSoup* soup;
  double in_plane, on_border;
  const Segment* segments = nullptr;  // occlusion: the packet's; a ray's id is its place in it
  Vec3 origin, direction;             // nearest hit
  bool front_only = false;
};
static_assert(std::is_standard_layout_v<Query>, "a pointer to the context must lead to the query");

bool is_between(const Query& query, const Segment& segment, std::size_t id) {
  const int plane = query.soup->plane[id];
  if (plane >= 0 && (plane == segment.from_plane || plane == segment.to_plane)) return false;
  const SoupTriangle triangle(*query.soup, id);
  const double from = triangle.height(segment.from), to = triangle.height(segment.to);
  if (!(std::min(from, to) < -query.in_plane && std::max(from, to) > query.in_plane)) return false;
  const Vec3 crossing = segment.from + from / (from - to) * (segment.to - segment.from);
  return triangle.contains(crossing, query.on_border);
}

bool is_ahead(const Query& query, std::size_t id) {
  const SoupTriangle triangle(*query.soup, id);
  const double height = triangle.height(query.origin), rise = triangle.normal.dot(query.direction);
  if (query.front_only && rise >= 0) return false;
  if (!(height > query.in_plane ? rise < 0 : height < -query.in_plane && rise > 0)) return false;
  return triangle.contains(query.origin - height / rise * query.direction, query.on_border);
}

void filter_occlusion(const RTCFilterFunctionNArguments* args) {
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const Segment& segment = query.segments[RTCRayN_id(args->ray, args->N, i)];
    const unsigned triangle = RTCHitN_primID(args->hit, args->N, i);
    if (!is_between(query, segment, triangle)) args->valid[i] = 0;
  }
}

void filter_hit(const RTCFilterFunctionNArguments* args) {
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i] != 0 && !is_ahead(query, RTCHitN_primID(args->hit, args->N, i)))
      args->valid[i] = 0;
}

float narrow(double x) { return static_cast<float>(x); }

}  // namespace

struct VisibilityIndex::Impl {
  TriangleSoup soup;
  Vec3 centre = Vec3::Zero();
  double scale = 1;  // a power of two; (p − centre)·scale lies in [−1, 1]
  double in_plane = 0, on_border = 0, in_shaft = 0;  // scene units
  Device device;
  EmbreeScene scene;  // null if there are no triangles
  mutable std::once_flag planted;
  mutable std::optional<TriangleTree> tree;  // made by the first shaft query

  explicit Impl(TriangleSoup triangles) : soup(std::move(triangles)) {
    check(soup);
    if (soup.triangles.empty()) return;
    measure();
    build();
  }

  void measure();
  void build();
  std::optional<Ray> ray(const Segment& segment) const;
  Query query(bool coherent) const;
  void packet(std::span<const Segment> segments, std::span<std::uint8_t> result) const;
};

/// Finds the map to Embree's coordinates.
void VisibilityIndex::Impl::measure() {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& corners : soup.triangles)
    for (const int v : corners) {
      low = low.cwiseMin(soup.points[static_cast<std::size_t>(v)]);
      high = high.cwiseMax(soup.points[static_cast<std::size_t>(v)]);
    }
  const double half = (high / 2 - low / 2).maxCoeff();
  const double reach = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
  if (!(half < largest_extent) || (half > 0 && half < 1 / largest_extent))
    throw Error(ErrorCode::contract, "VisibilityIndex",
                fmt::format("the triangles extend over {}, out of range", 2 * half));
  centre = low / 2 + high / 2;
  if (half > 0) scale = std::exp2(-std::ilogb(half) - 1);
  const double rounding = 16 * std::numeric_limits<double>::epsilon() * reach;
  in_plane = in_plane_distance * half + rounding;
  on_border = on_border_distance * half + rounding;
  in_shaft = in_shaft_distance * half + rounding;
}

void VisibilityIndex::Impl::build() {
  device.reset(rtcNewDevice(nullptr));
  throw_on_error(device.get());
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                             3 * soup.triangles.size()));
  auto* corners = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), soup.triangles.size()));
  throw_on_error(device.get());
  std::iota(corners, corners + 3 * soup.triangles.size(), 0u);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    for (const Vec3& p : enlarged(SoupTriangle(soup, t), enlargement / scale, miter_limit))
      for (int axis = 0; axis < 3; ++axis) *points++ = narrow((p[axis] - centre[axis]) * scale);
  rtcSetGeometryOccludedFilterFunction(geometry, filter_occlusion);
  rtcSetGeometryIntersectFilterFunction(geometry, filter_hit);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  // On one thread the tree, and with it the choice between equally near triangles, is always the
  // same.
  tbb::task_arena(1).execute([&] { rtcJoinCommitScene(scene.get()); });
  throw_on_error(device.get());
}

std::optional<Ray> VisibilityIndex::Impl::ray(const Segment& segment) const {
  const Vec3 from = (segment.from - centre) * scale, to = (segment.to - centre) * scale;
  const Vec3 way = to - from;
  const double length = way.norm();
  if (!(length > 0 && length < std::numeric_limits<double>::infinity())) return std::nullopt;
  const Vec3 direction = way / length;
  Ray ray{from - lengthening * direction, direction, length + 2 * lengthening};
  const bool inside =
      std::max(from.lpNorm<Eigen::Infinity>(), to.lpNorm<Eigen::Infinity>()) <= 1 + lengthening;
  if (!inside && !clip_to_cube(ray)) return std::nullopt;
  return ray;
}

Query VisibilityIndex::Impl::query(bool coherent) const {
  Query query{};
  rtcInitIntersectContext(&query.context);
  if (coherent) query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  query.soup = &soup;
  query.in_plane = in_plane;
  query.on_border = on_border;
  return query;
}

void VisibilityIndex::Impl::packet(std::span<const Segment> segments,
                                   std::span<std::uint8_t> result) const {
  alignas(64) RTCRay16 rays{};
  alignas(64) int valid[packet_size] = {};
  std::optional<Ray> first;
  bool bundle = true;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::optional<Ray> r = ray(segments[i]);
    if (!r) continue;
    if (!first) first = r;
    bundle = bundle && (r->origin - first->origin).squaredNorm() < bundle_spread * bundle_spread &&
             (r->end() - first->end()).squaredNorm() < bundle_spread * bundle_spread;
    valid[i] = -1;
    rays.org_x[i] = narrow(r->origin.x());
    rays.org_y[i] = narrow(r->origin.y());
    rays.org_z[i] = narrow(r->origin.z());
    rays.dir_x[i] = narrow(r->direction.x());
    rays.dir_y[i] = narrow(r->direction.y());
    rays.dir_z[i] = narrow(r->direction.z());
    rays.tfar[i] = narrow(r->length);
    rays.mask[i] = ~0u;
    rays.id[i] = static_cast<unsigned>(i);
  }
  Query q = query(bundle);
  q.segments = segments.data();
  rtcOccluded16(valid, scene.get(), &q.context, &rays);
  for (std::size_t i = 0; i < segments.size(); ++i)
    result[i] = valid[i] != 0 && rays.tfar[i] < 0 ? 1 : 0;
}

VisibilityIndex::VisibilityIndex(TriangleSoup soup)
    : impl_(std::make_unique<Impl>(std::move(soup))) {}
VisibilityIndex::~VisibilityIndex() = default;
VisibilityIndex::VisibilityIndex(VisibilityIndex&&) noexcept = default;
VisibilityIndex& VisibilityIndex::operator=(VisibilityIndex&&) noexcept = default;

const TriangleSoup& VisibilityIndex::soup() const { return impl_->soup; }

namespace {

RTCRay to_embree(const Ray& ray) {
  RTCRay out{};
  out.org_x = narrow(ray.origin.x());
  out.org_y = narrow(ray.origin.y());
  out.org_z = narrow(ray.origin.z());
  out.dir_x = narrow(ray.direction.x());
  out.dir_y = narrow(ray.direction.y());
  out.dir_z = narrow(ray.direction.z());
  out.tfar = narrow(ray.length);
  out.mask = ~0u;
  return out;
}

}  // namespace

bool VisibilityIndex::blocked(const Segment& segment) const {
  if (!impl_->scene) return false;
  const std::optional<Ray> ray = impl_->ray(segment);
  if (!ray) return false;
  Query query = impl_->query(false);
  query.segments = &segment;
  RTCRay embree_ray = to_embree(*ray);
  rtcOccluded1(impl_->scene.get(), &query.context, &embree_ray);
  return embree_ray.tfar < 0;
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
      impl_->packet(segments.subspan(i, count), result.subspan(i, count));
    }
  };
  if (segments.size() <= serial_limit) return run(0, segments.size());
  parallel_for((segments.size() + chunk_size - 1) / chunk_size, [&](std::size_t chunk) {
    run(chunk * chunk_size, std::min((chunk + 1) * chunk_size, segments.size()));
  });
}

std::optional<Hit> VisibilityIndex::first_hit(const Vec3& origin, const Vec3& direction,
                                              Sides sides) const {
  const Impl& impl = *impl_;
  if (!impl.scene || !origin.allFinite() || !direction.allFinite()) return std::nullopt;
  const Vec3 unit = direction.stableNormalized();
  if (unit.isZero()) return std::nullopt;
  const Vec3 start = (origin - impl.centre) * impl.scale - lengthening * unit;
  Ray ray{start, unit, std::numeric_limits<double>::infinity()};
  if (!clip_to_cube(ray)) return std::nullopt;
  Query query = impl.query(false);
  query.origin = origin;
  query.direction = unit;
  query.front_only = sides == Sides::front_only;
  RTCRayHit found{};
  found.ray = to_embree(ray);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl.scene.get(), &query.context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const std::size_t triangle = found.hit.primID;
  const SoupTriangle corners(impl.soup, triangle);
  Hit hit;
  hit.owner = impl.soup.owner[triangle];
  hit.triangle = static_cast<int>(triangle);
  hit.distance = -corners.height(origin) / corners.normal.dot(unit);
  hit.weights = corners.weights(origin + hit.distance * unit);
  return hit;
}

std::vector<int> VisibilityIndex::candidates(std::span<const Vec3> a,
                                             std::span<const Vec3> b) const {
  const Impl& impl = *impl_;
  if (a.empty() || b.empty())
    throw Error(ErrorCode::contract, "VisibilityIndex::candidates", "a polygon has no vertices");
  if (!impl.scene) return {};
  std::call_once(impl.planted, [&] { impl.tree.emplace(impl.soup, impl.centre); });
  std::vector<Vec3> local;
  for (const auto& polygon : {a, b})
    for (const Vec3& p : polygon) local.push_back(p - impl.centre);
  const auto split = std::span<const Vec3>(local);
  std::vector<int> found;
  impl.tree->find(make_shaft(split.first(a.size()), split.subspan(a.size()), impl.in_shaft), found);
  for (int& id : found) id = impl.soup.owner[static_cast<std::size_t>(id)];
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace halfshade
