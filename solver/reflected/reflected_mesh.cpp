#include "solver/reflected/reflected_mesh.h"

#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {
namespace {

// Below these shares of the length that elements were to have, their order is 1, and 0.
constexpr double share_of_linear = 0.3, share_of_constant = 0.05;

/// Of an equilateral triangle of area 1.
const double equilateral_edge = 2 / std::sqrt(std::sqrt(3.));

double length_of(const TriangleForest& forest, int triangle) {
  const auto& c = forest.corners(triangle);
  const double longest = std::sqrt(std::max(
      {(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(), (c[0] - c[2]).squaredNorm()}));
  return std::sqrt(longest * equilateral_edge * std::sqrt(forest.area(triangle)));
}

Bounds box_of(const std::array<Vec3, 3>& corners) {
  Bounds box;
  for (const Vec3& p : corners) box.include(p);
  return box;
}

/// Of the roots that are not huge; empty if none is.
FlatTree boxes_but(const HugeRoots& huge, const ElementTable& roots) {
  std::vector<Bounds> boxes;
  for (std::size_t r = 0; r < huge.is_huge.size(); ++r)
    if (!huge.is_huge[r]) boxes.push_back(box_of(roots.triangle(static_cast<int>(r))));
  return make_flat_tree(boxes, 1);
}

bool is_far(const Bounds& box, const FlatTree& others) {
  bool meets = false;
  visit_overlaps(others, box, [&](int) { meets = true; });
  return !meets;
}

/// Those of a triangle.
void number_leaves(ReflectedMesh& mesh, int triangle) {
  if (mesh.forest.is_leaf(triangle)) {
    mesh.element[at(triangle)] = mesh.count();
    mesh.triangle.push_back(triangle);
    return;
  }
  const int half = mesh.forest.first_half(triangle);
  for (const int t : {half, half + 1}) number_leaves(mesh, t);
}

void number_elements(ReflectedMesh& mesh) {
  mesh.triangle.clear();
  mesh.element.assign(at(mesh.forest.count()), -1);
  for (int root = 0; root < mesh.forest.root_count(); ++root) number_leaves(mesh, root);
}

void split(ReflectedMesh& mesh, int triangle, int times) {
  if (times == 0) return;
  mesh.forest.bisect(triangle);
  mesh.order.resize(at(mesh.forest.count()), mesh.order[at(triangle)]);
  mesh.stays_constant.resize(at(mesh.forest.count()), false);
  const int half = mesh.forest.first_half(triangle);
  split(mesh, half, times - 1);
  split(mesh, half + 1, times - 1);
}

ElementNodes make_nodes(int order) {
  ElementNodes nodes;
  const auto rule = triangle_rule(2 * order);
  Eigen::VectorXd weights(rule.size());
  for (const TriangleNode& n : rule) {
    weights[static_cast<Eigen::Index>(nodes.places.size())] = n.weight;
    nodes.places.emplace_back(n.u, n.v);
  }
  nodes.fit = basis_at(order, nodes.places).transpose() * weights.asDiagonal();
  nodes.spread.resize(order + 1, nodes.fit.cols());
  for (int d = 0; d <= order; ++d)
    nodes.spread.row(d) = nodes.fit.middleRows(basis_size(d - 1), d + 1).colwise().squaredNorm();
  return nodes;
}

}  // namespace

ReflectedMesh make_reflected_mesh(const ElementTable& roots, double length, int order,
                                  int max_elements, const HugeRoots& huge) {
  ReflectedMesh mesh(roots);
  mesh.huge = huge;
  mesh.highest_order = order;
  const FlatTree others = boxes_but(huge, roots);
  int leaves = roots.count();
  for (int t = 0; t < mesh.forest.count() && leaves < max_elements; ++t) {
    const double own = length_of(mesh.forest, t);
    if (own <= length) continue;
    if (huge(mesh.forest.root(t)) && is_far(box_of(mesh.forest.corners(t)).grown(own), others))
      continue;
    mesh.forest.bisect(t);
    ++leaves;
  }
  for (int t = 0; t < mesh.forest.count(); ++t) {
    const double share = equilateral_edge * std::sqrt(mesh.forest.area(t)) / length;
    const int allowed = share > share_of_linear ? max_reflected_order : share > share_of_constant;
    mesh.order.push_back(std::min(order, allowed));
  }
  mesh.stays_constant.resize(mesh.order.size(), false);
  number_elements(mesh);
  return mesh;
}

void refine(ReflectedMesh& mesh, std::span<const int> wanted, const std::vector<int>& times) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const int t = mesh.triangle[at(wanted[i])];
    if (mesh.order[at(t)] < mesh.highest_order && !mesh.stays_constant[at(t)])
      mesh.order[at(t)] = mesh.highest_order;
    else
      split(mesh, t, times[i]);
  }
  number_elements(mesh);
}

void make_constant(ReflectedMesh& mesh, std::span<const int> elements) {
  for (const int e : elements) {
    const std::size_t t = at(mesh.triangle[at(e)]);
    mesh.order[t] = 0;
    mesh.stays_constant[t] = true;
  }
}

ReflectedMesh bisected(ReflectedMesh mesh, int times) {
  for (const int t : mesh.triangle) split(mesh, t, times);
  number_elements(mesh);
  return mesh;
}

ElementField zero_field(const ReflectedMesh& mesh) {
  std::vector<int> order;
  for (const int t : mesh.triangle) order.push_back(mesh.order[at(t)]);
  return zero_field(std::move(order));
}

ElementTable element_table(const ReflectedMesh& mesh, const ElementTable& roots) {
  ElementTable table;
  for (int e = 0; e < mesh.count(); ++e) {
    const std::size_t root = at(mesh.root(e));
    const int p = static_cast<int>(table.points.size());
    const auto& corners = mesh.forest.corners(mesh.triangle[at(e)]);
    table.points.insert(table.points.end(), corners.begin(), corners.end());
    table.corners.push_back({p, p + 1, p + 2});
    table.neighbours.push_back({-1, -1, -1});
    table.normal.push_back(roots.normal[root]);
    table.area.push_back(mesh.area(e));
    table.surface.push_back(roots.surface[root]);
    table.face.push_back(roots.face[root]);
    table.group.push_back(roots.group[root]);
    table.material.push_back(roots.material[root]);
    table.level.push_back(mesh.forest.level(mesh.triangle[at(e)]));
    table.edge_order.push_back({-1, -1, -1});
  }
  return table;
}

const ElementNodes& element_nodes_of(int order) {
  static const std::array<ElementNodes, max_reflected_order + 1> all = {
      make_nodes(0), make_nodes(1), make_nodes(2), make_nodes(3)};
  return all[at(order)];
}

}  // namespace halfshade
