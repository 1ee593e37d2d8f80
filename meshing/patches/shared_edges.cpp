#include "meshing/patches/shared_edges.h"

#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace halfshade {
namespace {

// The point nearest to t among sorted ones.
double gap(const std::vector<double>& sorted, double t) {
  const auto next = std::lower_bound(sorted.begin(), sorted.end(), t);
  double least = HUGE_VAL;
  if (next != sorted.end()) least = *next - t;
  if (next != sorted.begin()) least = std::min(least, t - *std::prev(next));
  return least;
}

// Sorts, and leaves out what is near the one before.
void thin(std::vector<double>& values, double distance) {
  std::sort(values.begin(), values.end());
  std::vector<double> kept;
  for (const double t : values)
    if (kept.empty() || t - kept.back() > distance) kept.push_back(t);
  values = std::move(kept);
}

}  // namespace

BorderEdges border_edges(const CurveMesh& mesh) {
  const std::vector<Vec2>& points = mesh.mesh.points;
  BorderEdges borders;
  for (std::size_t i = 0; i < mesh.mesh.constrained_edges.size(); ++i) {
    const auto& edge = mesh.mesh.constrained_edges[i];
    if (mesh.is_d0[i]) borders.push_back({edge, {points[at(edge[0])], points[at(edge[1])]}});
  }
  return borders;
}

SharedEdges::SharedEdges(const SoundScene& scene)
    : scene_(scene), lines_(find_shared_lines(scene)) {
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
    std::vector<Bounds> boxes;
    for (int w = lines_.first_border[r]; w < lines_.first_border[r + 1]; ++w)
      boxes.push_back(flat_bounds(lines_.borders[at(w)].ends[0], lines_.borders[at(w)].ends[1]));
    trees_.push_back(make_flat_tree(boxes, 1));
  }
  for (const SharedLine& line : lines_.lines) {
    std::vector<double>& points = agreed_.emplace_back();
    for (const int w : line.borders) {
      points.push_back(lines_.borders[at(w)].begin);
      points.push_back(lines_.borders[at(w)].end);
    }
    thin(points, line.length);
  }
}

int SharedEdges::border_of(int surface, const Segment2& edge) const {
  const Vec2 middle = 0.5 * (edge[0] + edge[1]);
  const double planarity = tolerance_of(scene_.surfaces[at(surface)]).planarity;
  const Bounds around = flat_bounds(middle, middle).grown(planarity);
  std::pair<double, int> best{planarity, -1};
  visit_overlaps(trees_[at(surface)], around, [&](int i) {
    const int w = lines_.first_border[at(surface)] + i;
    const Segment2& border = lines_.borders[at(w)].ends;
    const double off = std::max(distance_to_segment(edge[0], border[0], border[1]),
                                distance_to_segment(edge[1], border[0], border[1]));
    if (off < best.first || (off == best.first && w < best.second)) best = {off, w};
  });
  return best.second;
}

void SharedEdges::add(std::span<const End> ends) {
  std::vector<std::vector<std::pair<double, double>>> found(
      lines_.lines.size());  // where on the line, snap
  for (const End& end : ends) {
    const Bounds around = flat_bounds(end.point, end.point).grown(end.snap);
    const auto r = at(end.surface);
    visit_overlaps(trees_[r], around, [&](int i) {
      const BorderLine& border = lines_.borders[at(lines_.first_border[r] + i)];
      if (border.line < 0 ||
          distance_to_segment(end.point, border.ends[0], border.ends[1]) > end.snap)
        return;
      const double t = along(lines_.lines[at(border.line)], scene_.surfaces[r].frame, end.point);
      found[at(border.line)].emplace_back(t, end.snap);
    });
  }
  for (std::size_t l = 0; l < found.size(); ++l) {
    std::sort(found[l].begin(), found[l].end());
    std::vector<double> added;
    for (const auto& [t, snap] : found[l])
      if (gap(agreed_[l], t) > snap && (added.empty() || t - added.back() > snap))
        added.push_back(t);
    agreed_[l].insert(agreed_[l].end(), added.begin(), added.end());
    std::sort(agreed_[l].begin(), agreed_[l].end());
  }
}

// The points of a line inside a part of it, from its begin to its end, which may be the lower.
std::vector<double> SharedEdges::inside(int line, double begin, double end) const {
  if (line < 0) return {};
  const std::vector<double>& points = agreed_[at(line)];
  const double length = lines_.lines[at(line)].length;
  const double low = std::min(begin, end) + length;
  const double high = std::max(begin, end) - length;
  std::vector<double> result;
  for (auto t = std::upper_bound(points.begin(), points.end(), low); t != points.end() && *t < high;
       ++t)
    result.push_back(*t);
  if (begin > end) std::reverse(result.begin(), result.end());
  return result;
}

Outline SharedEdges::outline(int surface) const {
  Outline result;
  int w = lines_.first_border[at(surface)];
  const auto points_from = [&](const BorderLine& border) {
    std::vector<Vec2> points = {border.ends[0]};
    for (const double t : inside(border.line, border.begin, border.end))
      points.push_back(border.ends[0] + (t - border.begin) / (border.end - border.begin) *
                                            (border.ends[1] - border.ends[0]));
    return points;
  };
  for (const Ring& ring : scene_.surfaces[at(surface)].rings) {
    Ring& longer = result.rings.emplace_back();
    for (std::size_t k = 0; k < ring.size(); ++k, ++w) {
      const std::vector<Vec2> points = points_from(lines_.borders[at(w)]);
      longer.insert(longer.end(), points.begin(), points.end());
    }
  }
  for (; w < lines_.first_border[at(surface) + 1]; ++w) {
    std::vector<Vec2> points = points_from(lines_.borders[at(w)]);
    points.push_back(lines_.borders[at(w)].ends[1]);
    for (std::size_t k = 1; k < points.size(); ++k)
      result.contacts.push_back({points[k - 1], points[k]});
  }
  return result;
}

// Decides what the line is to have between its points, and marks surfaces that differ.
void SharedEdges::agree(std::size_t line, std::vector<Vertex> vertices,
                        std::vector<bool>& differs) {
  const double tolerance = lines_.lines[line].length;
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const std::vector<double> before = agreed_[line];
  for (auto first = vertices.begin(); first != vertices.end();) {
    const std::size_t interval = first->interval;
    std::map<int, std::vector<double>> borders;
    for (; first != vertices.end() && first->interval == interval; ++first)
      borders[first->border].push_back(first->t);
    const auto finest = std::max_element(borders.begin(), borders.end(), [](auto& a, auto& b) {
      return a.second.size() < b.second.size();
    });
    for (const int w : lines_.lines[line].borders) {
      const BorderLine& border = lines_.borders[at(w)];
      if (std::min(border.begin, border.end) > before[interval - 1] + tolerance ||
          std::max(border.begin, border.end) < before[interval] - tolerance)
        continue;
      const auto own = borders.find(w);
      const bool same = own != borders.end() &&
                        std::equal(own->second.begin(), own->second.end(), finest->second.begin(),
                                   finest->second.end(), [&](double a, double b) {
                                     return std::abs(a - b) <= tolerance;
                                   });
      if (!same) differs[at(border.surface)] = true;
    }
    agreed_[line].insert(agreed_[line].end(), finest->second.begin(), finest->second.end());
  }
  std::sort(agreed_[line].begin(), agreed_[line].end());
}

std::vector<int> SharedEdges::compare(std::span<const CurveMesh> meshes) {
  std::vector<std::vector<Vertex>> vertices(lines_.lines.size());
  for (std::size_t r = 0; r < meshes.size(); ++r)
    for (const BorderEdge& edge : border_edges(meshes[r])) {
      const int w = border_of(static_cast<int>(r), edge.ends);
      if (w < 0 || lines_.borders[at(w)].line < 0) continue;
      const int line = lines_.borders[at(w)].line;
      const std::vector<double>& points = agreed_[at(line)];
      for (const Vec2& p : edge.ends) {
        const double t = along(lines_.lines[at(line)], scene_.surfaces[r].frame, p);
        const auto next = std::upper_bound(points.begin(), points.end(), t);
        if (next == points.begin() || next == points.end() ||
            gap(points, t) <= lines_.lines[at(line)].length)
          continue;
        vertices[at(line)].push_back({static_cast<std::size_t>(next - points.begin()), w, t});
      }
    }
  std::vector<bool> differs(meshes.size(), false);
  for (std::size_t l = 0; l < vertices.size(); ++l) agree(l, std::move(vertices[l]), differs);
  std::vector<int> result;
  for (std::size_t r = 0; r < differs.size(); ++r)
    if (differs[r]) result.push_back(static_cast<int>(r));
  return result;
}

}  // namespace halfshade
