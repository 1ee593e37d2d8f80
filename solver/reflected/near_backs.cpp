#include "solver/reflected/near_backs.h"

#include "meshing/geometry/line.h"
#include "solver/elements/polynomial.h"
#include "solver/exchange/form_factor.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace halfshade {
namespace {

/// Gaps up to this many times an element's size are near: of those nodes may miss a thousandth.
constexpr double nearest_back = 1.5;
constexpr double least_height = 1e-9;  // of an element's size
/// Light changes within the distance from a border: parts of an element are at most this share of
/// it long, or have this share of the area of all, or what changes in them has that share: less
/// than that hardly counts, the less as it may be too much or too little.
constexpr double share_of_distance = 0.93, least_part = 1e-7, least_change = 1e-6;
/// Narrower elements are a thousand times as long as wide, as where corners of two surfaces differ
/// by rounding: too little to integrate over.
constexpr double narrow = 1e-3;
/// Beyond so many heights beside a back it hides next to nothing: h² / 4d² of the hemisphere, if it
/// rises h above the element's plane.
constexpr double changes_within = 4;
/// Where nodes see less than this of what is not hidden, they do not tell how bright that is.
constexpr double hardly_seen = 1e-3;
/// What arrives past backs is not quite even: so much of what nodes miss is not known.
constexpr double unsure_past_backs = 0.2;

double longest_length(const std::array<Vec3, 3>& triangle) {
  const std::size_t k = at(longest_edge(triangle));
  return (triangle[(k + 1) % 3] - triangle[k]).norm();
}

/// The part of a triangle's area from which something changes below a back or close beside it.
double changing_share(const std::array<Vec3, 3>& triangle, const Vec3& normal, const NearBack& back,
                      double length) {
  std::vector<Vec3> part(triangle.begin(), triangle.end());
  const double whole = area_vector(part).norm();
  for (std::size_t k = 0; k < 3 && !part.empty(); ++k) {
    const Vec3 inward = (back.corners[(k + 1) % 3] - back.corners[k]).cross(normal).normalized();
    part = clip_to_front(part, back.corners[k] - changes_within * back.rise * inward, inward);
  }
  const double below = part.empty() ? 0 : area_vector(part).norm() / std::max(whole, DBL_MIN);
  // ∫ h² / 4d² over what lies farther away than that.
  return std::min(below + back.rise / (4 * changes_within * length), 1.);
}

double distance(const Vec3& p, const NearBack& back) {
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k)
    least = std::min(least, distance_to_span(p, {back.corners[k], back.corners[(k + 1) % 3]}));
  return least;
}

/// A part of an element, by its share of the area, and the largest share of that over which light
/// changes with one of the backs; 0 if it need not be cut.
struct ElementPart {
  std::array<TrianglePlace, 3> corners;
  double share = 0, changing = 0;

  /// What changes in it, as a share of the element.
  double change() const { return share * changing; }
};

/// ∫ ω and ∫ ω (ω − π) over an element, in the mean.
class ShadowIntegrals {
 public:
  ShadowIntegrals(const std::array<Vec3, 3>& corners, const Vec3& normal, int order,
                  const std::vector<NearBack>& backs, double most_looks)
      : corners_(corners), normal_(normal), order_(order), backs_(backs) {
    const ElementNodes& nodes = element_nodes_of(order);
    at_nodes.resize(static_cast<Eigen::Index>(nodes.places.size()));
    for (std::size_t n = 0; n < nodes.places.size(); ++n)
      at_nodes[static_cast<Eigen::Index>(n)] = seen_past(position(corners_, nodes.places[n]));
    polynomial_ = nodes.fit * at_nodes;
    cut(most_looks / static_cast<double>(backs.size()));
    Eigen::VectorXd basis(basis_size(order_));
    for (const ElementPart& part : parts_) add(part, basis);
  }

  Eigen::VectorXd at_nodes;  ///< ω
  double all = 0, missed = 0;
  double unseen = 0;  ///< of `missed`, in parts that should have been cut, as their nodes tell

 private:
  double seen_past(const Vec3& p) const {
    double hidden = 0;
    for (const NearBack& back : backs_) hidden += point_to_polygon(p, normal_, back.corners);
    return std::clamp(1 - hidden, 0., 1.);
  }

  ElementPart part_of(const std::array<TrianglePlace, 3>& corners, double share) const {
    ElementPart part{corners, share};
    if (!(share > least_part)) return part;
    const std::array<Vec3, 3> at_corners = positions(corners);
    const Vec3 middle = (at_corners[0] + at_corners[1] + at_corners[2]) / 3;
    const double length = longest_length(at_corners);
    for (const NearBack& back : backs_)
      if (length > share_of_distance * distance(middle, back))
        part.changing = std::max(part.changing, changing_share(at_corners, normal_, back, length));
    if (!(part.change() > least_change)) part.changing = 0;
    return part;
  }

  std::array<Vec3, 3> positions(const std::array<TrianglePlace, 3>& corners) const {
    return {position(corners_, corners[0]), position(corners_, corners[1]),
            position(corners_, corners[2])};
  }

  /// In two again and again, at longest edges.
  void cut(double most_parts) {
    const auto changes_less = [](const ElementPart& a, const ElementPart& b) {
      return a.change() < b.change();
    };
    parts_ = {part_of({TrianglePlace(0, 0), TrianglePlace(1, 0), TrianglePlace(0, 1)}, 1)};
    while (parts_.front().changing > 0 && static_cast<double>(parts_.size()) < most_parts) {
      std::ranges::pop_heap(parts_, changes_less);
      const ElementPart part = parts_.back();
      parts_.pop_back();
      const std::size_t k = at(longest_edge(positions(part.corners)));
      const TrianglePlace &a = part.corners[k], &b = part.corners[(k + 1) % 3],
                          &c = part.corners[(k + 2) % 3];
      for (const auto& half : {std::array{a, TrianglePlace((a + b) / 2), c},
                               std::array{TrianglePlace((a + b) / 2), b, c}}) {
        parts_.push_back(part_of(half, part.share / 2));
        std::ranges::push_heap(parts_, changes_less);
      }
    }
  }

  void add(const ElementPart& part, Eigen::VectorXd& basis) {
    const auto& [a, b, c] = part.corners;
    double least = 1, most = 0;
    for (const TriangleNode& node : triangle_rule(4)) {
      const TrianglePlace place = a + node.u * (b - a) + node.v * (c - a);
      const double past = seen_past(position(corners_, place));
      least = std::min(least, past);
      most = std::max(most, past);
      basis_at(order_, place, basis);
      all += part.share * node.weight * past;
      missed += part.share * node.weight * past * (past - basis.dot(polynomial_));
    }
    unseen += part.change() * (most - least);
  }

  const std::array<Vec3, 3>& corners_;
  const Vec3& normal_;
  int order_;
  const std::vector<NearBack>& backs_;
  Eigen::VectorXd polynomial_;
  std::vector<ElementPart> parts_;  ///< a heap, first what changes most
};

}  // namespace

NearBacks::NearBacks(const ReflectingScene& scene) : scene_(scene) {
  std::vector<Bounds> boxes;
  for (int r = 0; r < scene.roots.count(); ++r) {
    const int behind = scene.cells.of_side[at(r)][1];
    if (scene.cells.closed[at(behind)]) continue;
    backs_.push_back(r);
    Bounds box;
    for (const Vec3& p : scene.roots.triangle(r)) box.include(p);
    boxes.push_back(box);
  }
  boxes_ = make_flat_tree(boxes, 1);
}

NearBacks::Near NearBacks::near(const ReflectedMesh& mesh, int element) const {
  Near result;
  const int root = mesh.root(element), cell = scene_.cells.before(root);
  if (scene_.cells.swallowing[at(cell)] < 0 || backs_.empty()) return result;
  const std::array<Vec3, 3>& corners = mesh.forest.corners(mesh.triangle[at(element)]);
  const Vec3& normal = scene_.roots.normal[at(root)];
  const std::vector<int>& plane = scene_.visibility.soup().plane;
  const double size = std::sqrt(mesh.area(element));
  Bounds box;
  for (const Vec3& p : corners) box.include(p);
  result.height = HUGE_VAL;
  visit_overlaps(boxes_, box.grown(nearest_back * size), [&](int k) {
    const int r = backs_[at(k)];
    // Corners that elements share with neighbours may lie off the plane of both.
    if (plane[at(r)] == plane[at(root)]) return;
    const Vec3& looks = scene_.roots.normal[at(r)];
    if (scene_.cells.of_side[at(r)][1] != cell || !(looks.dot(normal) > 0)) return;
    const std::array<Vec3, 3> back = scene_.roots.triangle(r);
    double low = HUGE_VAL, high = -HUGE_VAL, rise = -HUGE_VAL;
    for (const Vec3& p : corners) {
      low = std::min(low, -looks.dot(p - back[0]));
      high = std::max(high, -looks.dot(p - back[0]));
    }
    for (const Vec3& p : back) rise = std::max(rise, normal.dot(p - corners[0]));
    if (std::min(low, rise) < least_height * size || high > nearest_back * size) return;
    result.backs.push_back({{back[0], back[2], back[1]}, rise});
    result.height = std::min(result.height, low);
  });
  return result;
}

BackShadow NearBacks::shadow(const ReflectedMesh& mesh, int element, double most_looks) const {
  BackShadow shadow;
  const Near found = near(mesh, element);
  if (found.backs.empty()) return shadow;
  shadow.height = found.height;
  const std::array<Vec3, 3>& corners = mesh.forest.corners(mesh.triangle[at(element)]);
  const double longest = longest_length(corners);
  if (2 * mesh.area(element) < narrow * longest * longest) {
    shadow.share = 1;
    return shadow;
  }
  const int order = mesh.order[at(mesh.triangle[at(element)])];
  const ShadowIntegrals integrals(corners, scene_.roots.normal[at(mesh.root(element))], order,
                                  found.backs, most_looks);
  const Eigen::VectorXd& past = integrals.at_nodes;
  const Eigen::RowVectorXd weights = element_nodes_of(order).fit.row(0);
  if (!(integrals.all > 0)) return shadow;
  const double missed = integrals.missed / integrals.all;
  const double all_missed = missed + std::copysign(integrals.unseen / integrals.all, missed);
  shadow.share = all_missed / std::max(integrals.all, hardly_seen);
  if (shadow.share == 0) return shadow;
  // What arrives past the backs if nothing were hidden: least squares over the nodes.
  const double seen = weights * past.cwiseAbs2();
  if (!(seen > hardly_seen * hardly_seen)) return shadow;
  shadow.of_nodes = (missed / seen) * weights.cwiseProduct(past.transpose());
  shadow.unsure = 1 - (1 - unsure_past_backs) * missed / all_missed;
  return shadow;
}

}  // namespace halfshade
