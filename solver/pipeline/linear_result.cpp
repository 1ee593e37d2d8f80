#include "solver/pipeline/linear_result.h"

#include "solver/elements/joined_field.h"
#include "solver/elements/linear_pieces.h"
#include "solver/elements/solution_parts.h"
#include "solver/elements/vertex_values.h"
#include "solver/pipeline/straight_files.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// What lines may be off in a picture: no more than the result is, or than anybody sees.
double allowed_to_see(const SolveResult& result) {
  double area = 0;
  for (const double a : result.elements.area) area += a;
  const double square = square_integral(result.irradiance, result.elements);
  return area > 0 ? std::max(result.relative_error, invisible_share) * std::sqrt(square / area) : 0;
}

/// The elements that pieces are of, one a piece.
ElementTable piece_table(const ElementTable& whole, LinearPieces& pieces) {
  ElementTable table;
  table.points = std::move(pieces.points);
  table.corners = std::move(pieces.corners);
  table.neighbours.assign(table.corners.size(), {-1, -1, -1});
  table.edge_order.assign(table.corners.size(), {-1, -1, -1});
  for (const int e : pieces.element) {
    table.normal.push_back(whole.normal[at(e)]);
    table.area.push_back(whole.area[at(e)] / pieces.pieces[at(e)]);
    table.surface.push_back(whole.surface[at(e)]);
    table.face.push_back(whole.face[at(e)]);
    table.group.push_back(whole.group[at(e)]);
    table.material.push_back(whole.material[at(e)]);
    table.level.push_back(whole.level[at(e)]);
  }
  return table;
}

/// Of points on elements, in the elements' order.
std::vector<ChannelArray> bounces_at(const SolveResult& result, const std::vector<int>& element,
                                     const std::vector<Vec3>& points) {
  std::vector<ChannelArray> values;
  const auto add = [&](const ElementField& field) {
    ChannelArray& here = values.emplace_back(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
      here.row(static_cast<Eigen::Index>(i)) =
          value_at(field, element[i], place_of(result.elements.triangle(element[i]), points[i]));
  };
  if (!result.bounces.empty()) add(result.direct);
  for (const ElementField& field : result.bounces) add(field);
  return values;
}

std::vector<std::array<Vec3, 3>> triangles_of(const ElementTable& elements) {
  std::vector<std::array<Vec3, 3>> triangles;
  for (int e = 0; e < elements.count(); ++e) triangles.push_back(elements.triangle(e));
  return triangles;
}

/// `off` is what they miss of the polynomials, on each element.
LinearResult of_pieces(const SolveResult& result, LinearPieces pieces, const Eigen::ArrayXd& off) {
  LinearResult out;
  out.bounces = bounces_at(result, pieces.element_of_point, pieces.points);
  out.elements = piece_table(result.elements, pieces);
  out.is_border = std::move(pieces.is_border);
  out.solution = solution_of_parts(result.solution, pieces.element);
  for (Eigen::Index i = 0; i < out.solution.error_estimate.size(); ++i) {
    double& error = out.solution.error_estimate[i];  // of the channels' mean
    error = std::hypot(error, off[pieces.element[static_cast<std::size_t>(i)]] / std::sqrt(3.));
  }
  const std::size_t emitters = result.emitters.size();
  for (const int e : pieces.element)
    if (!result.regions.empty())
      for (std::size_t k = 0; k < emitters; ++k)
        out.regions.push_back(result.regions[at(e) * emitters + k]);
  const auto points = static_cast<Eigen::Index>(pieces.value.size());
  out.irradiance.resize(points, 3);
  for (Eigen::Index i = 0; i < points; ++i)
    out.irradiance.row(i) = pieces.value[static_cast<std::size_t>(i)];
  out.radiosity = result.solution.exitance(pieces.element_of_point, Eigen::all) +
                  result.solution.rho(pieces.element_of_point, Eigen::all) * out.irradiance;
  return out;
}

}  // namespace

NodeValues node_values(const SolveResult& result) {
  NodeValues nodes;
  int count = 0;
  for (const int order : result.irradiance.order) {
    nodes.order.push_back(std::max(order, 1));
    count += basis_size(nodes.order.back());
  }
  nodes.irradiance.resize(count, 3);
  nodes.radiosity.resize(count, 3);
  Eigen::Index row = 0;
  std::vector<int> element;
  for (int e = 0; e < result.elements.count(); ++e) {
    const auto triangle = result.elements.triangle(e);
    const std::vector<TrianglePlace> places = element_nodes(nodes.order[at(e)]);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const TrianglePlace& place = places[k];
      // To the last bit where elements meet.
      nodes.points.push_back(k < 3 ? triangle[k] : position(triangle, place));
      element.push_back(e);
      nodes.irradiance.row(row) = value_at(result.irradiance, e, place);
      nodes.radiosity.row(row) =
          result.solution.exitance.row(e) + result.solution.rho.row(e) * nodes.irradiance.row(row);
      ++row;
    }
  }
  nodes.bounces = bounces_at(result, element, nodes.points);
  return nodes;
}

LinearResult linear_result(const SolveResult& result) {
  if (result.irradiance.count() > 0) {
    const StraightCut cut = is_cut(result) ? result.straight : cut_to(result, little_error(result));
    LinearResult out = of_pieces(
        result, linear_pieces(triangles_of(result.elements), result.irradiance, cut.along_edge),
        cut.off);
    out.relative_error = error_of_triangles(result, cut);
    return out;
  }
  return {result.elements,
          {},
          result.solution,
          values_at_points(result.elements, result.solution.irradiance),
          values_at_points(result.elements, result.solution.radiosity),
          {},
          result.regions,
          result.relative_error};
}

LinearResult joined_linear_result(const SolveResult& result) {
  if (result.irradiance.count() == 0) return linear_result(result);
  ElementField irradiance = result.irradiance;
  join(result.elements, result.solution.error_estimate, irradiance);
  return of_pieces(result,
                   linear_pieces(triangles_of(result.elements), irradiance, allowed_to_see(result)),
                   Eigen::ArrayXd::Zero(irradiance.count()));
}

}  // namespace halfshade
