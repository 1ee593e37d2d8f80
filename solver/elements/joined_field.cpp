#include "solver/elements/joined_field.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/geometry/corner_fans.h"
#include "meshing/geometry/triangle_height.h"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// Of an element's error: changes of all its values that are not worth making.
constexpr double share_of_error = 1e-3;
/// Of the largest coefficient: what rounding changes.
constexpr double rounding = 1e-13;

/// Place on the edge from corner k to k + 1.
TrianglePlace on_edge(int k, double s) {
  const std::array<TrianglePlace, 3> corner = {TrianglePlace(0, 0), {1, 0}, {0, 1}};
  return (1 - s) * corner[at(k)] + s * corner[at((k + 1) % 3)];
}

/// What takes coefficients to values on edges and back.
class EdgeBasis {
 public:
  EdgeBasis() {
    for (int p = 0; p <= max_order; ++p) {
      if (p > 0) from_nodes_[at(p)] = element_node_basis(p).inverse();
      for (int q = 1; q <= max_order; ++q)
        for (int k = 0; k < 3; ++k) {
          std::vector<TrianglePlace> places;
          for (int j = 0; j <= q; ++j) places.push_back(on_edge(k, static_cast<double>(j) / q));
          on_edge_[at(p)][at(q)][at(k)] = basis_at(p, places);
        }
    }
  }

  /// Polynomials of order p at q + 1 places of edge k, from corner k to k + 1.
  const Eigen::MatrixXd& values(int p, int q, int k) const { return on_edge_[at(p)][at(q)][at(k)]; }
  /// Takes values at element_nodes(p), p > 0, to coefficients.
  const Eigen::MatrixXd& from_nodes(int p) const { return from_nodes_[at(p)]; }

 private:
  std::array<std::array<std::array<Eigen::MatrixXd, 3>, max_order + 1>, max_order + 1> on_edge_;
  std::array<Eigen::MatrixXd, max_order + 1> from_nodes_;
};

/// The index of the edge of `element` that it shares with `neighbour`.
int edge_to(const ElementTable& elements, int element, int neighbour) {
  const auto& all = elements.neighbours[at(element)];
  return static_cast<int>(std::find(all.begin(), all.end(), neighbour) - all.begin());
}

/// Of the height of a triangle: one so much less high beside it has no say in what it looks like.
/// Such strips come from the digits of coordinates more often than not, by which one facet of a
/// chair reaches behind the next, and what is true of them is not seen.
constexpr double no_say = 0.01;

/// Where borders turn back by more than so much (its sine), something stands at the corner.
constexpr double turns_back = 0.1;

/// Points where light depends on the direction one comes from: where a D0 line ends within a
/// surface, for both sides of it have the point in common, and at corners round which a surface
/// goes by more than half a turn, for shadows of what stands there begin at them.
std::vector<bool> without_single_value(const ElementTable& elements) {
  // Borders that leave each point and that arrive at it, once they are known.
  std::vector<Vec3> leaving(elements.points.size(), Vec3::Zero());
  std::vector<bool> has_left(elements.points.size(), false), result(elements.points.size(), false);
  const auto each_border = [&](const auto& use) {
    for (int e = 0; e < elements.count(); ++e)
      for (int k = 0; k < 3; ++k)
        if (elements.neighbours[at(e)][at(k)] < 0) use(e, k);
  };
  const auto corner = [&](int e, int k) { return elements.corners[at(e)][at(k % 3)]; };
  each_border([&](int e, int k) {
    leaving[at(corner(e, k))] = elements.points[at(corner(e, k + 1))];
    has_left[at(corner(e, k))] = true;
  });
  each_border([&](int e, int k) {
    const int point = corner(e, k + 1);
    if (!has_left[at(point)]) return;
    const Vec3 &from = elements.points[at(corner(e, k))], &here = elements.points[at(point)],
               &apex = elements.points[at(corner(e, k + 2))];
    const Vec3 arriving = (here - from).normalized(),
               next = (leaving[at(point)] - here).normalized(),
               normal = (here - from).cross(apex - from).normalized();
    if (leaving[at(point)] == from || arriving.cross(next).dot(normal) < -turns_back)
      result[at(point)] = true;
  });
  return result;
}

class Joining {
 public:
  Joining(const ElementTable& elements, const Eigen::ArrayXd& error, const ElementField& field)
      : elements_(elements), field_(field), has_many_(without_single_value(elements)) {
    const double largest = field.coefficients.abs().maxCoeff();
    // What is off by rounding alone is exact, and nothing is off by more than all there is.
    const Eigen::ArrayXd relative =
        (error / (largest > 0 ? largest : 1)).max(rounding).min(1).eval();
    weight_ = (relative / rounding).square().inverse();
    least_change_ = (share_of_error * relative + rounding) * largest;
    highest_.assign(elements.points.size(), 0);
    for (int e = 0; e < field.count(); ++e) {
      const auto& [a, b, c] = elements.corners[at(e)];
      height_.push_back(shortest_height(
          {elements.points[at(a)], elements.points[at(b)], elements.points[at(c)]}));
      for (const int point : {a, b, c})
        highest_[at(point)] = std::max(highest_[at(point)], height_.back());
      int order = std::max(field.order[at(e)], 1);
      for (const int n : elements.neighbours[at(e)])
        if (n >= 0) order = std::max(order, field.order[at(n)]);
      order_.push_back(order);
    }
  }

  ElementField joined() const {
    std::vector<ChannelArray> changes = all_changes();
    std::vector<int> order = field_.order;
    for (std::size_t e = 0; e < order.size(); ++e)
      if (changes[e].size() > 0) order[e] = order_[e];
    ElementField result = zero_field(std::move(order));
    for (int e = 0; e < result.count(); ++e) {
      const auto before = field_.of(e);
      result.of(e).topRows(before.rows()) = before;
      if (changes[at(e)].size() > 0)
        result.of(e) += (basis_.from_nodes(result.order[at(e)]) * changes[at(e)].matrix()).array();
    }
    return result;
  }

 private:
  /// The polynomial of an element along its edge k, at order + 1 places of it.
  ChannelArray along(int element, int order, int k) const {
    return basis_.values(field_.order[at(element)], order, k) * field_.of(element).matrix();
  }

  Rgb at_corner(int element, int k) const { return along(element, 1, k).row(0).transpose(); }

  ChannelArray values_at_points() const {
    const auto count = static_cast<Eigen::Index>(elements_.points.size());
    ChannelArray sum = ChannelArray::Zero(count, 3);
    Eigen::ArrayXd weight = Eigen::ArrayXd::Zero(count);
    for (int e = 0; e < field_.count(); ++e)
      for (int k = 0; k < 3; ++k) {
        const int point = elements_.corners[at(e)][at(k)];
        if (height_[at(e)] < no_say * highest_[at(point)]) continue;
        sum.row(point) += weight_[e] * at_corner(e, k).transpose();
        weight[point] += weight_[e];
      }
    return sum.colwise() / (weight > 0).select(weight, 1.);
  }

  /// What continuity changes at the nodes of each element; nothing where it is not worth it.
  std::vector<ChannelArray> all_changes() const {
    const ChannelArray at_points = values_at_points();
    std::vector<ChannelArray> changes(order_.size());
    parallel_for(order_.size(), [&](std::size_t i) {
      const int e = static_cast<int>(i);
      ChannelArray change = changes_of(e, at_points);
      if (change.abs().maxCoeff() > least_change_[e]) changes[i] = std::move(change);
    });
    return changes;
  }

  ChannelArray changes_of(int element, const ChannelArray& at_points) const {
    const int q = order_[at(element)];
    ChannelArray change = ChannelArray::Zero(basis_size(q), 3);
    for (int k = 0; k < 3; ++k) {
      const int point = elements_.corners[at(element)][at(k)];
      if (!has_many_[at(point)])
        change.row(k) = at_points.row(point) - at_corner(element, k).transpose();
    }
    for (int k = 0; k < 3; ++k) {
      const ChannelArray off = change_along(element, q, k);
      // At its ends the edge changes as the corners do.
      const auto first = (change.row(k) - off.row(0)).eval();
      const auto last = (change.row((k + 1) % 3) - off.row(q)).eval();
      for (int j = 1; j < q; ++j) {
        const double s = static_cast<double>(j) / q;
        change.row(3 + k * (q - 1) + j - 1) = off.row(j) + (1 - s) * first + s * last;
      }
    }
    return change;
  }

  /// From what the element says of its edge k to the average with what the neighbour says.
  ChannelArray change_along(int element, int order, int k) const {
    const int n = elements_.neighbours[at(element)][at(k)];
    if (n < 0) return ChannelArray::Zero(order + 1, 3);
    const double share = share_of(n, element);
    return share * (along(n, order, edge_to(elements_, n, element)).colwise().reverse() -
                    along(element, order, k));
  }

  /// Of what is said of their common edge: what comes from `element`.
  double share_of(int element, int neighbour) const {
    const double here = height_[at(element)], there = height_[at(neighbour)];
    if (here < no_say * there) return 0;
    if (there < no_say * here) return 1;
    return weight_[element] / (weight_[element] + weight_[neighbour]);
  }

  const ElementTable& elements_;
  const ElementField& field_;
  std::vector<bool> has_many_;   ///< values, see without_single_value
  Eigen::ArrayXd weight_;        ///< of what each element says
  std::vector<double> height_;   ///< of each, see no_say
  std::vector<double> highest_;  ///< of those round each point
  Eigen::ArrayXd least_change_;  ///< of each that is worth making
  std::vector<int> order_;
  EdgeBasis basis_;
};

}  // namespace

ElementTable connected(std::span<const std::array<Vec3, 3>> triangles, std::span<const int> surface,
                       std::vector<std::array<int, 3>> edge_order) {
  std::map<std::array<double, 3>, int> places;
  std::vector<std::array<int, 3>> vertices;
  for (const auto& triangle : triangles) {
    auto& corners = vertices.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = triangle[k];
      corners[k] =
          places.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(places.size())).first->second;
    }
  }
  // By surface and ends; −1 where several have the same one.
  std::map<std::array<int, 3>, int> element_of_edge;
  const auto each_edge = [&](const auto& use) {
    for (std::size_t e = 0; e < vertices.size(); ++e)
      for (std::size_t k = 0; k < 3; ++k)
        if (edge_order[e][k] != 0) use(e, k, vertices[e][k], vertices[e][(k + 1) % 3]);
  };
  each_edge([&](std::size_t e, std::size_t, int from, int to) {
    const auto [entry, is_new] =
        element_of_edge.try_emplace({surface[e], from, to}, static_cast<int>(e));
    if (!is_new) entry->second = -1;
  });
  ElementTable table;
  table.neighbours.assign(vertices.size(), {-1, -1, -1});
  each_edge([&](std::size_t e, std::size_t k, int from, int to) {
    const auto across = element_of_edge.find({surface[e], to, from});
    const bool is_pair = across != element_of_edge.end() && across->second != static_cast<int>(e) &&
                         element_of_edge.at({surface[e], from, to}) >= 0;
    if (is_pair) table.neighbours[e][k] = across->second;
  });
  const CornerFans fans = corner_fans(vertices, table.neighbours);
  table.points.resize(at(fans.count));
  for (std::size_t e = 0; e < vertices.size(); ++e)
    for (std::size_t k = 0; k < 3; ++k) table.points[at(fans.of_corner[e][k])] = triangles[e][k];
  table.corners = fans.of_corner;
  table.edge_order = std::move(edge_order);
  return table;
}

void join(const ElementTable& elements, const Eigen::ArrayXd& error, ElementField& field) {
  if (field.count() != elements.count() || error.size() != elements.count())
    throw Error(ErrorCode::contract, "join",
                fmt::format("{} elements have {} polynomials and {} errors", elements.count(),
                            field.count(), error.size()));
  if (field.count() > 0) field = Joining(elements, error, field).joined();
}

}  // namespace halfshade
