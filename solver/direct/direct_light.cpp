#include "solver/direct/direct_light.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/backprojection/sight_candidates.h"
#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/geometry/flat_tree.h"
#include "solver/direct/edge_derivatives.h"
#include "solver/direct/emitter_target.h"
#include "solver/elements/quadrature.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

namespace halfshade {
namespace {

constexpr std::size_t chunk = 64;  // points of one task
/// So few points are not divided: each looks by itself through what may be in their way.
constexpr int few_points = 4;
/// Scenes of fewer edges are looked through as quickly by each point as by several together.
constexpr int few_edges = 64;

/// Sums over emitters at a point that DirectLight does not hold.
struct Tally {
  double visible = 0, unobstructed = 0, strongest = 0;
  bool is_away = false;  ///< from the emitter that is looked at
};

/// What each thread keeps between calls.
struct Worker {
  VisiblePartFinder finder;
  VisiblePart part;
  std::vector<Tally> tallies;
  std::vector<Vec3> positions;
  std::vector<SightCandidates> candidates;  ///< by depth in the tree of points
};

/// Points, and a tree over where they lie.
struct PointTree {
  std::span<const SurfacePoint> points;
  FlatTree tree;
  std::vector<int> tasks;  ///< nodes that together hold all
};

PointTree make_point_tree(std::span<const SurfacePoint> points) {
  PointTree result{points, {}, {}};
  std::vector<Bounds> boxes;
  boxes.reserve(points.size());
  for (const SurfacePoint& point : points) boxes.push_back({point.position, point.position});
  result.tree = make_flat_tree(boxes, few_points);
  const auto take = [&](int node) {
    const bool is_task = result.tree.nodes[at(node)].count <= static_cast<int>(chunk);
    if (is_task) result.tasks.push_back(node);
    return is_task;
  };
  walk_tree(result.tree, take, [](int) {});
  return result;
}

PointFactor factor_of(const VisiblePart& part, const EmitterTarget& target,
                      const SurfacePoint& point) {
  PointFactor factor;
  factor.region = part.region;
  factor.signature = part.signature;
  if (factor.region == Region::away) return factor;
  factor.unobstructed = unobstructed_factor(point.position, point.normal, target.rings);
  if (factor.region == Region::lit) factor.visible = factor.unobstructed;
  if (factor.region == Region::penumbra)
    factor.visible =
        std::min(factor.unobstructed, enclosed_factor(point.position, point.normal, part.pieces));
  return factor;
}

void add(const PointFactor& factor, const EmitterTarget& source, Tally& tally, DirectLight& light) {
  light.irradiance += factor.visible * source.exitance;
  tally.visible += factor.visible * source.strength;
  tally.unobstructed += factor.unobstructed * source.strength;
  if (factor.unobstructed * source.strength > tally.strongest) {
    tally.strongest = factor.unobstructed * source.strength;
    light.region = factor.region;
  }
}

void finish(const Tally& tally, DirectLight& light) {
  if (tally.unobstructed > 0) light.visible = tally.visible / tally.unobstructed;
}

/// Leaves the boundary in worker.part.
PointFactor find_factor(Worker& worker, const EmitterTarget& target, const SurfacePoint& point,
                        int id) {
  worker.finder.find(point.position, point.normal, id, worker.part);
  return factor_of(worker.part, target, point);
}

/// Without a signature, and with nothing left in worker.part: what takes less where very much lies
/// before the emitter.
PointFactor find_light(Worker& worker, const EmitterTarget& target, const SurfacePoint& point,
                       int id, const SightCandidates* candidates, std::size_t& crowd_work) {
  VisiblePartFinder& finder = worker.finder;
  if (candidates != nullptr
          ? finder.find_unless_crowded(point.position, point.normal, id, *candidates, worker.part)
          : finder.find_unless_crowded(point.position, point.normal, id, worker.part))
    return factor_of(worker.part, target, point);
  PointFactor factor;
  bool is_lit = true, is_dark = true;
  crowd_work += finder.find_in_cells(
      point.position, point.normal, id, worker.part, [&](const VisiblePart& part) {
        factor.visible += enclosed_factor(point.position, point.normal, part.pieces);
        is_lit = is_lit && part.region == Region::lit;
        is_dark = is_dark && part.region == Region::umbra;
      });
  factor.unobstructed = unobstructed_factor(point.position, point.normal, target.rings);
  factor.visible = is_lit ? factor.unobstructed : std::min(factor.visible, factor.unobstructed);
  factor.region = is_lit ? Region::lit : is_dark ? Region::umbra : Region::penumbra;
  return factor;
}

}  // namespace

double in_rays(const SightEffort& effort, double crowd_work) {
  constexpr double look = 8, turn = 0.15, exact_turn = 2, box = 0.03, crowd = 3;
  return look * static_cast<double>(effort.looks) + turn * static_cast<double>(effort.turns) +
         exact_turn * static_cast<double>(effort.exact_turns) +
         box * static_cast<double>(effort.boxes) + crowd * crowd_work;
}

struct DirectLightIndex::Impl {
  std::shared_ptr<const OpaqueScene> opaque;
  std::vector<EmitterTarget> targets;  // by surface
  std::vector<int> emitters;
  tbb::enumerable_thread_specific<Worker> workers;

  Impl(const SoundScene& scene, std::shared_ptr<const OpaqueScene> shared)
      : opaque(std::move(shared)), workers([this] {
          Worker worker{VisiblePartFinder(*opaque), {}, {}, {}, {}};
          worker.candidates.resize(FlatTree::max_stack);
          return worker;
        }) {
    for (const Surface& surface : scene.surfaces) {
      targets.push_back(make_emitter_target(scene, surface));
      if (targets.back().strength > 0) emitters.push_back(static_cast<int>(targets.size()) - 1);
    }
  }

  const EmitterTarget& target(int surface) const {
    if (surface < 0 || surface >= static_cast<int>(targets.size()))
      throw Error(ErrorCode::contract, "DirectLightIndex",
                  fmt::format("there is no surface {} among {}", surface, targets.size()));
    return targets[static_cast<std::size_t>(surface)];
  }

  DirectLight gather(Worker& worker, const SurfacePoint& point, std::span<const int> from) const {
    DirectLight light;
    const SightEffort before = worker.finder.effort();
    Tally tally;
    for (const int emitter : from) {
      const EmitterTarget& source = targets[static_cast<std::size_t>(emitter)];
      if (is_clearly_away(source, point)) continue;
      add(find_light(worker, source, point, emitter, nullptr, light.crowd_work), source, tally,
          light);
    }
    finish(tally, light);
    light.effort = worker.finder.effort() - before;
    return light;
  }

  /// The same for the points below a node of their tree, which look through the scene together.
  void gather(Worker& worker, const PointTree& points, int node,
              std::span<DirectLight> light) const {
    const FlatTree::Node& all = points.tree.nodes[at(node)];
    worker.tallies.assign(at(all.count), {});
    for (const int emitter : emitters) {
      const EmitterTarget& source = targets[at(emitter)];
      for (int i = 0; i < all.count; ++i)
        worker.tallies[at(i)].is_away =
            is_clearly_away(source, points.points[at(points.tree.items[at(all.first + i)])]);
      look(worker, points, {node, all.first, emitter}, nullptr, 0, light);
    }
    for (int i = 0; i < all.count; ++i)
      finish(worker.tallies[at(i)], light[at(points.tree.items[at(all.first + i)])]);
  }

  struct Look {
    int node;
    int first;  // of the worker's tallies, among the tree's items
    int emitter;
  };

  /// The more points lie together, the less there is between them and the emitter.
  void look(Worker& worker, const PointTree& points, const Look& at_node,
            const SightCandidates* among, std::size_t depth, std::span<DirectLight> light) const {
    const auto [index, first, emitter] = at_node;
    const FlatTree::Node& node = points.tree.nodes[at(index)];
    worker.positions.clear();
    for (int i = node.first; i < node.first + node.count; ++i)
      if (!worker.tallies[at(i - first)].is_away)
        worker.positions.push_back(points.points[at(points.tree.items[at(i)])].position);
    if (worker.positions.empty()) return;
    SightCandidates& candidates = worker.candidates[depth];
    worker.finder.find_candidates(worker.positions, emitter, among, candidates);
    if (node.right >= 0) {
      look(worker, points, {index + 1, first, emitter}, &candidates, depth + 1, light);
      look(worker, points, {node.right, first, emitter}, &candidates, depth + 1, light);
      return;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      if (worker.tallies[at(i - first)].is_away) continue;
      const int k = points.tree.items[at(i)];
      const SightEffort before = worker.finder.effort();
      const PointFactor factor = find_light(worker, targets[at(emitter)], points.points[at(k)],
                                            emitter, &candidates, light[at(k)].crowd_work);
      add(factor, targets[at(emitter)], worker.tallies[at(i - first)], light[at(k)]);
      light[at(k)].effort += worker.finder.effort() - before;
    }
  }
};

DirectLightIndex::DirectLightIndex(const SoundScene& scene)
    : DirectLightIndex(scene, std::make_shared<const OpaqueScene>(scene)) {}
DirectLightIndex::DirectLightIndex(const SoundScene& scene,
                                   std::shared_ptr<const OpaqueScene> opaque)
    : impl_(std::make_unique<Impl>(scene, std::move(opaque))) {}
DirectLightIndex::~DirectLightIndex() = default;
DirectLightIndex::DirectLightIndex(DirectLightIndex&&) noexcept = default;
DirectLightIndex& DirectLightIndex::operator=(DirectLightIndex&&) noexcept = default;

std::span<const int> DirectLightIndex::emitters() const { return impl_->emitters; }

PointFactor DirectLightIndex::factor(const SurfacePoint& point, int emitter) const {
  const EmitterTarget& target = impl_->target(emitter);
  if (is_clearly_away(target, point)) return {};
  Worker& worker = impl_->workers.local();
  return find_factor(worker, target, point, emitter);
}

PointFactorDerivatives DirectLightIndex::factor_derivatives(const SurfacePoint& point,
                                                            int emitter) const {
  const EmitterTarget& target = impl_->target(emitter);
  if (is_clearly_away(target, point)) return {};
  Worker& worker = impl_->workers.local();
  PointFactorDerivatives result;
  result.factor = find_factor(worker, target, point, emitter);
  const EdgeDerivatives derivatives = edge_derivatives(point.position, point.normal, worker.part);
  result.gradient = derivatives.gradient;
  result.hessian = derivatives.hessian;
  return result;
}

void DirectLightIndex::visible_part(const SurfacePoint& point, int surface,
                                    VisiblePart& part) const {
  impl_->target(surface);
  Worker& worker = impl_->workers.local();
  worker.finder.find(point.position, point.normal, surface, part);
}

DirectLight DirectLightIndex::irradiance(const SurfacePoint& point) const {
  Worker& worker = impl_->workers.local();
  return impl_->gather(worker, point, impl_->emitters);
}

DirectLight DirectLightIndex::irradiance(const SurfacePoint& point, int emitter) const {
  impl_->target(emitter);
  return impl_->gather(impl_->workers.local(), point, {&emitter, 1});
}

int DirectLightIndex::strongest_emitter(const SurfacePoint& point) const {
  int strongest = -1;
  double most = 0;
  for (const int emitter : impl_->emitters) {
    const EmitterTarget& source = impl_->targets[at(emitter)];
    if (is_clearly_away(source, point)) continue;
    const double light =
        source.strength * unobstructed_factor(point.position, point.normal, source.rings);
    if (light <= most) continue;
    most = light;
    strongest = emitter;
  }
  return strongest;
}

Region DirectLightIndex::region(const SurfacePoint& point) const {
  const int strongest = strongest_emitter(point);
  if (strongest < 0) return Region::away;
  return irradiance(point, strongest).region;
}

std::vector<DirectLight> DirectLightIndex::irradiance(std::span<const SurfacePoint> points,
                                                      const Progress& progress) const {
  std::vector<DirectLight> light(points.size());
  if (impl_->opaque->edge_count() >= few_edges) {
    const PointTree tree = make_point_tree(points);
    parallel_for(
        tree.tasks.size(),
        [&](std::size_t task) {
          impl_->gather(impl_->workers.local(), tree, tree.tasks[task], light);
        },
        progress, "direct light");
    return light;
  }
  parallel_for((points.size() + chunk - 1) / chunk,
               [&](std::size_t c) {
                 Worker& worker = impl_->workers.local();
                 const std::size_t end = std::min(points.size(), (c + 1) * chunk);
                 for (std::size_t k = c * chunk; k < end; ++k)
                   light[k] = impl_->gather(worker, points[k], impl_->emitters);
               },
               progress, "direct light");
  return light;
}

std::vector<SurfacePoint> element_centres(const ElementTable& elements) {
  std::vector<SurfacePoint> centres;
  centres.reserve(elements.corners.size());
  for (int e = 0; e < elements.count(); ++e) {
    const auto [a, b, c] = elements.triangle(e);
    centres.push_back({(a + b + c) / 3, elements.normal[at(e)]});
  }
  return centres;
}

ElementDirectLight element_direct_light(const SoundScene& scene, const ElementTable& elements,
                                        const DirectLightIndex& index, int points_per_element,
                                        const Progress& progress) {
  const int degree = points_per_element <= 1   ? 1
                     : points_per_element <= 3 ? 2
                     : points_per_element <= 6 ? 4
                                               : 6;
  const auto rule = triangle_rule(degree);
  const std::size_t count = elements.corners.size();
  ElementDirectLight light;
  light.emitters.assign(index.emitters().begin(), index.emitters().end());
  light.factor =
      Eigen::ArrayXXd::Zero(elements.count(), static_cast<Eigen::Index>(light.emitters.size()));
  light.region.assign(count, Region::away);
  const auto element = [&](std::size_t e) {
    const auto [a, b, c] = elements.triangle(static_cast<int>(e));
    const Surface& surface = scene.surfaces[at(elements.surface[e])];
    double strongest = 0;
    for (std::size_t k = 0; k < light.emitters.size(); ++k) {
      const Surface& source = scene.surfaces[static_cast<std::size_t>(light.emitters[k])];
      if (source.plane == surface.plane) continue;
      double visible = 0, unobstructed = 0;
      for (const TriangleNode& node : rule) {
        const Vec3 position = a + node.u * (b - a) + node.v * (c - a);
        const SurfacePoint point{surface.frame.foot(position), elements.normal[e]};
        const PointFactor factor = index.factor(point, light.emitters[k]);
        visible += node.weight * factor.visible;
        unobstructed += node.weight * factor.unobstructed;
      }
      light.factor(static_cast<Eigen::Index>(e), static_cast<Eigen::Index>(k)) = visible;
      const double strength =
          unobstructed * scene.materials[static_cast<std::size_t>(source.material)].exitance.mean();
      if (strength <= strongest) continue;
      strongest = strength;
      light.region[e] = visible == 0              ? Region::umbra
                        : visible == unobstructed ? Region::lit
                                                  : Region::penumbra;
    }
  };
  parallel_for((count + chunk - 1) / chunk,
               [&](std::size_t c) {
                 for (std::size_t e = c * chunk; e < std::min(count, (c + 1) * chunk); ++e)
                   element(e);
               },
               progress, "direct light");
  return light;
}

ChannelArray irradiance_of(const ElementDirectLight& light, const SoundScene& scene) {
  ChannelArray irradiance = ChannelArray::Zero(light.factor.rows(), 3);
  for (std::size_t k = 0; k < light.emitters.size(); ++k) {
    const Surface& source = scene.surfaces[static_cast<std::size_t>(light.emitters[k])];
    const Rgb& exitance = scene.materials[static_cast<std::size_t>(source.material)].exitance;
    irradiance +=
        (light.factor.col(static_cast<Eigen::Index>(k)).matrix() * exitance.matrix().transpose())
            .array();
  }
  return irradiance;
}

}  // namespace halfshade
