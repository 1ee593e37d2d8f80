#include "meshing/discontinuity/swath_cuts.h"

#include "meshing/discontinuity/margins.h"
#include "meshing/events/margins.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {
namespace {

// How many parts of a swath are bounded, and searched for edges, each on its own.
constexpr int parts_per_swath = 4;

double box_slack(const Swath& swath) {
  double slack = 0;
  if (swath.is_planar)
    slack = std::max(margins::slack_at(swath.apex), margins::slack_of(swath.base));
  else
    for (const Span3& edge : swath.edges) slack = std::max(slack, margins::slack_of(edge));
  return margins::box_growth * slack;
}

}  // namespace

SwathCuts::SwathCuts(const SoundScene& scene, const OpaqueScene& opaque,
                     const EmitterScene& emitter_scene)
    : opaque_(opaque.topology()),
      silhouette_trees_(opaque.silhouette_trees()),
      emitter_scene_(emitter_scene) {
  for (const auto& edge : opaque_.edges) {
    const auto surface_of = [&](int i) {
      return opaque_.triangles[at(opaque_.incidences[at(edge.first + i)].triangle)].surface;
    };
    is_inner_.push_back(edge.count == 2 && surface_of(0) == surface_of(1));
  }
  std::vector<Bounds> boxes;
  for (const Surface& surface : scene.surfaces)
    for (const auto& [from, to] : surface.contacts) {
      const Span3 contact = {surface.frame.to_space(from), surface.frame.to_space(to)};
      contacts_.push_back({contact, tolerance_of(surface).length});
      boxes.push_back(bounds_of(contact.from, contact.to));
    }
  contact_tree_ = make_tight_tree(boxes);
}

Span3 SwathCuts::span_of(int edge) const {
  const auto [from, to] = opaque_.ends(opaque_.edges[at(edge)]);
  return {from, to};
}

std::vector<double> SwathCuts::limits(const Swath& swath) const {
  std::vector<double> limits = {0, 1};
  own_limits(swath, limits);
  for (const OutlinePiece& piece : emitter_scene_.outline)
    critical_parameters(swath, piece.span, emitter_scene_.joined, limits);
  add_grazing(swath, limits);
  std::sort(limits.begin(), limits.end());
  return limits;
}

/// Where the faces at the edges that make the swath turn from one side to the other.
void SwathCuts::add_grazing(const Swath& swath, std::vector<double>& parameters) const {
  const auto add = [&](int e) {
    const SilhouetteEdge& edge = emitter_scene_.edges[at(e)];
    for (int f = edge.first_face; f < edge.first_face + edge.face_count; ++f)
      grazing_parameters(swath, emitter_scene_.faces[at(f)].normal, parameters);
  };
  for (const int e : swath.silhouettes)
    if (e >= 0) add(e);
  if (swath.corner >= 0)
    for (const int e : emitter_scene_.vertices[at(swath.corner)].edges) add(e);
}

std::size_t SwathCuts::between(const Swath& swath, double t0, double t1,
                               std::vector<double>& cuts) const {
  cuts.assign({t0, t1});
  const int parts = static_cast<int>(std::ceil(parts_per_swath * (t1 - t0)));
  std::size_t steps = 0;
  for (int k = 0; k < parts; ++k)
    steps += add_met(swath, t0 + k * (t1 - t0) / parts, t0 + (k + 1) * (t1 - t0) / parts, cuts);
  std::sort(cuts.begin(), cuts.end());
  return steps;
}

SwathCuts::Stretch SwathCuts::hidden_by(int triangle, const Swath& swath, double t, double t0,
                                        double t1) const {
  const OpaqueTopology::Triangle& blocker = opaque_.triangles[at(triangle)];
  std::array<Vec3, 3> corner;
  std::vector<double> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = opaque_.vertices[at(blocker.corner[k])];
    if (emitter_scene_.frame.height(corner[k]) <=
        std::max(emitter_scene_.slack, margins::slack_at(corner[k])))
      return {t, t};
    const int edge = blocker.edge[k];
    critical_parameters(swath, span_of(edge), opaque_.edges[at(edge)].joined, ends);
  }
  const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  grazing_parameters(swath, normal, ends);
  grazing_parameters(swath, emitter_scene_.frame.normal, ends);
  feature_parameters(swath, corner[0], normal, ends);
  Stretch hidden = {t0, t1};
  for (const double end : ends)
    if (end <= t)
      hidden.from = std::max(hidden.from, end);
    else
      hidden.to = std::min(hidden.to, end);
  return hidden;
}

std::size_t SwathCuts::add_met(const Swath& swath, double t0, double t1,
                               std::vector<double>& cuts) const {
  const SwathBounds bounds = bounds_of(swath, t0, t1);
  const double slack = box_slack(swath);
  std::size_t steps = 0;
  const PlaneFrame& emitter = emitter_scene_.frame;
  const auto is_missed = [&](const Bounds& box) {
    ++steps;
    return emitter.height(box.centre()) < -emitter.normal.cwiseAbs().dot(box.half_size()) - slack ||
           !bounds.may_meet(box, slack);
  };
  std::vector<double> found;
  const auto consider = [&](const Span3& span, double joined) {
    ++steps;
    if (bounds.may_meet(bounds_of(span.from, span.to), std::max(slack, joined)))
      critical_parameters(swath, span, joined, found);
  };
  const auto walk = [&](const FlatTree& tree, const auto& visit) {
    walk_tree(
        tree, [&](int node) { return is_missed(tree.nodes[at(node)].box); }, visit);
  };
  const auto consider_edge = [&](int e) {
    if (!is_inner_[at(e)]) consider(span_of(e), opaque_.edges[at(e)].joined);
  };
  walk(silhouette_trees_.closed_edges, consider_edge);
  walk(silhouette_trees_.open_edges, consider_edge);
  // Where surfaces cut each other there is no edge, but what blocks the line changes, too.
  walk(contact_tree_, [&](int c) { consider(contacts_[at(c)].span, contacts_[at(c)].joined); });
  for (const double t : found)
    if (t >= t0 && t <= t1) cuts.push_back(t);
  return steps;
}

}  // namespace halfshade
