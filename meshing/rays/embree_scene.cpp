#include "meshing/rays/embree_scene.h"

#include "meshing/core/error.h"

#include <embree3/rtcore.h>
#include <fmt/core.h>
#include <tbb/task_arena.h>

#include <algorithm>
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

// Corners of enlarged triangles move by at most this many times as much as their edges.
constexpr double miter_limit = 64;

// A packet whose origins and ends lie this close together is traced as one bundle, else ray by ray:
// measured, either is up to three times as fast as the other beyond this.
constexpr double bundle_spread = 0.2;

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceRelease>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;

void throw_on_error(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorCode::too_large, {}, "not enough memory for the triangles");
  throw Error(ErrorCode::contract, "VisibilityIndex",
              fmt::format("Embree failed with error {}", static_cast<int>(error)));
}

/// What the filters need to know of a query; Embree hands the context through to them.
struct Query {
  RTCIntersectContext context;
  const SoupTriangle* triangles;
  const Segment* segments = nullptr;  // occlusion: the packet's; a ray's id is its place in it
  const HalfLine* rays = nullptr;     // nearest hit: likewise
  bool front_only = false;
};
static_assert(std::is_standard_layout_v<Query>, "a pointer to the context must lead to the query");

bool is_between(const Query& query, const Segment& segment, std::size_t id) {
  const SoupTriangle& triangle = query.triangles[id];
  const int plane = triangle.plane;
  if (plane >= 0 && (plane == segment.from_plane || plane == segment.to_plane)) return false;
  if (triangle.side(segment.from) * triangle.side(segment.to) >= 0) return false;
  const double from = triangle.height(segment.from), to = triangle.height(segment.to);
  return triangle.contains(segment.from + from / (from - to) * (segment.to - segment.from));
}

bool is_ahead(const Query& query, const HalfLine& ray, std::size_t id) {
  const SoupTriangle& triangle = query.triangles[id];
  const double height = triangle.height(ray.origin), rise = triangle.normal.dot(ray.direction);
  if (query.front_only && rise >= 0) return false;
  if (!(triangle.side(ray.origin) * rise < 0)) return false;
  return triangle.contains(ray.origin - height / rise * ray.direction);
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
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const HalfLine& ray = query.rays[RTCRayN_id(args->ray, args->N, i)];
    if (!is_ahead(query, ray, RTCHitN_primID(args->hit, args->N, i))) args->valid[i] = 0;
  }
}

float narrow(double x) { return static_cast<float>(x); }

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

void put(const Ray& ray, std::size_t i, RTCRay16& packet) {
  packet.org_x[i] = narrow(ray.origin.x());
  packet.org_y[i] = narrow(ray.origin.y());
  packet.org_z[i] = narrow(ray.origin.z());
  packet.dir_x[i] = narrow(ray.direction.x());
  packet.dir_y[i] = narrow(ray.direction.y());
  packet.dir_z[i] = narrow(ray.direction.z());
  packet.tfar[i] = narrow(ray.length);
  packet.mask[i] = ~0u;
  packet.id[i] = static_cast<unsigned>(i);
}

Query query_of(const std::vector<SoupTriangle>& triangles, bool coherent) {
  Query query{};
  rtcInitIntersectContext(&query.context);
  if (coherent) query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  query.triangles = triangles.data();
  return query;
}

}  // namespace

struct EmbreeScene::Handles {
  Device device;
  SceneHandle scene;
};

EmbreeScene::EmbreeScene(const TriangleSoup& soup, std::span<const int> triangles)
    : space_(make_ray_space(soup, triangles)),
      ball_(space_.ball()),
      handles_(std::make_unique<Handles>()) {
  triangles_.reserve(triangles.size());
  for (const int t : triangles) triangles_.emplace_back(soup, t);
  auto& [device, scene] = *handles_;
  device.reset(rtcNewDevice(nullptr));
  throw_on_error(device.get());
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                             3 * triangles_.size()));
  auto* corners = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), triangles_.size()));
  throw_on_error(device.get());
  std::iota(corners, corners + 3 * triangles_.size(), 0u);
  for (const SoupTriangle& triangle : triangles_)
    for (const Vec3& p : enlarged(triangle, space_.enlargement, miter_limit))
      for (int axis = 0; axis < 3; ++axis)
        *points++ = narrow((p[axis] - space_.centre[axis]) * space_.scale);
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

EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene::~EmbreeScene() = default;

bool EmbreeScene::blocked(const Segment& segment) const {
  const std::optional<Ray> ray = space_.ray(segment.from, segment.to);
  if (!ray) return false;
  Query query = query_of(triangles_, false);
  query.segments = &segment;
  RTCRay embree_ray = to_embree(*ray);
  rtcOccluded1(handles_->scene.get(), &query.context, &embree_ray);
  return embree_ray.tfar < 0;
}

void EmbreeScene::blocked(std::span<const Segment> segments, std::span<std::uint8_t> result) const {
  alignas(64) RTCRay16 rays{};
  alignas(64) int valid[packet_size] = {};
  std::optional<Ray> first;
  bool bundle = true;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::optional<Ray> r = space_.ray(segments[i].from, segments[i].to);
    if (!r) continue;
    if (!first) first = r;
    bundle = bundle && (r->origin - first->origin).squaredNorm() < bundle_spread * bundle_spread &&
             (r->end() - first->end()).squaredNorm() < bundle_spread * bundle_spread;
    valid[i] = -1;
    put(*r, i, rays);
  }
  Query query = query_of(triangles_, bundle);
  query.segments = segments.data();
  rtcOccluded16(valid, handles_->scene.get(), &query.context, &rays);
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (valid[i] != 0 && rays.tfar[i] < 0) result[i] = 1;
}

const SoupTriangle* EmbreeScene::first_hit(const HalfLine& line, Sides sides) const {
  const std::optional<Ray> ray = space_.ray_ahead(line.origin, line.direction);
  if (!ray) return nullptr;
  Query query = query_of(triangles_, false);
  query.rays = &line;
  query.front_only = sides == Sides::front_only;
  RTCRayHit found{};
  found.ray = to_embree(*ray);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(handles_->scene.get(), &query.context, &found);
  return found.hit.geomID == RTC_INVALID_GEOMETRY_ID ? nullptr : &triangles_[found.hit.primID];
}

void EmbreeScene::first_hits(std::span<const HalfLine> rays, Sides sides,
                             std::span<const SoupTriangle*> triangles) const {
  alignas(64) RTCRayHit16 found{};
  alignas(64) int valid[packet_size] = {};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    found.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    const std::optional<Ray> r = space_.ray_ahead(rays[i].origin, rays[i].direction);
    if (!r) continue;
    valid[i] = -1;
    put(*r, i, found.ray);
  }
  Query query = query_of(triangles_, true);
  query.rays = rays.data();
  query.front_only = sides == Sides::front_only;
  rtcIntersect16(valid, handles_->scene.get(), &query.context, &found);
  for (std::size_t i = 0; i < rays.size(); ++i)
    triangles[i] =
        found.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? nullptr : &triangles_[found.hit.primID[i]];
}

}  // namespace halfshade
