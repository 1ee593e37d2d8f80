#include "meshing/repair/contacts.h"

#include "meshing/arrangement/arrangement.h"
#include "meshing/core/error.h"
#include "meshing/core/planar.h"
#include "meshing/geometry/flat_tree.h"
#include "meshing/repair/intersections.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

namespace halfshade {
namespace {

/// Of lines in one surface that may cross: a minute or so.
constexpr double most_pairs = 4e7;

std::vector<Link> links_of(const std::vector<std::vector<int>>& rings) {
  std::vector<Link> links;
  for (const auto& ring : rings)
    for (std::size_t k = 0; k < ring.size(); ++k)
      links.push_back(sorted_link(ring[k], ring[(k + 1) % ring.size()]));
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

/// An edge of a surface and the scale of the smallest surface that has it.
struct SurfaceEdge {
  Link link;
  LocalScale scale;
};

std::vector<SurfaceEdge> all_edges(const std::vector<SurfaceDraft>& drafts) {
  std::map<Link, LocalScale> scales;
  for (const SurfaceDraft& draft : drafts)
    for (const Link& link : links_of(draft.rings)) {
      const auto [entry, is_new] = scales.emplace(link, draft.scale);
      if (!is_new) entry->second = joint_scale(entry->second, draft.scale);
    }
  std::vector<SurfaceEdge> edges;
  for (const auto& [link, scale] : scales) edges.push_back({link, scale});
  return edges;
}

/// How far two segments reach through each other; 0 if they only touch.
double crossing_depth(const Segment2& s, const Segment2& t) {
  const Vec2 u = s[1] - s[0], v = t[1] - t[0];
  const double a = cross_2d(u, t[0] - s[0]), b = cross_2d(u, t[1] - s[0]);
  const double c = cross_2d(v, s[0] - t[0]), d = cross_2d(v, s[1] - t[0]);
  const auto are_opposite = [](double x, double y) { return (x > 0 && y < 0) || (x < 0 && y > 0); };
  if (!are_opposite(a, b) || !are_opposite(c, d)) return 0;
  return std::min(std::min(std::abs(a), std::abs(b)) / u.norm(),
                  std::min(std::abs(c), std::abs(d)) / v.norm());
}

// One surface with the edges that lie in its plane.
class ContactFinder {
 public:
  ContactFinder(SurfaceDraft& draft, std::vector<Vec3>& points) : draft_(draft), points_(points) {}

  void run(const std::vector<SurfaceEdge>& edges) {
    LocalScale scale = draft_.scale;
    for (const SurfaceEdge& edge : edges) scale = joint_scale(scale, edge.scale);
    tolerance_ = tolerance_of(scale);
    std::vector<Link> segments;
    for (const auto& ring : draft_.rings)
      for (std::size_t k = 0; k < ring.size(); ++k)
        segments.push_back({local(ring[k]), local(ring[(k + 1) % ring.size()])});
    border_ = segments;
    for (const SurfaceEdge& edge : edges)
      segments.push_back({local(edge.link[0]), local(edge.link[1])});
    arrangement_ = arrange(flat_, segments, {tolerance_.length, tolerance_.planarity});
    collect(edges.size());
    if (inner_.empty()) return;
    bend_border();
    straighten_crossings();
    for (std::size_t k = ids_.size(); k < arrangement_.points.size(); ++k) {
      ids_.push_back(static_cast<int>(points_.size()));
      points_.push_back(draft_.frame.to_space(arrangement_.points[k]));
    }
    update_rings();
    for (const Link& link : inner_)
      draft_.contacts.push_back(sorted_link(end_of_contact(link[0]), end_of_contact(link[1])));
    std::sort(draft_.contacts.begin(), draft_.contacts.end());
  }

 private:
  int local(int point) {
    const auto [entry, is_new] = local_.emplace(point, static_cast<int>(flat_.size()));
    if (is_new) {
      flat_.push_back(draft_.frame.to_plane(points_[at(point)]));
      ids_.push_back(point);
    }
    return entry->second;
  }

  void collect(std::size_t edge_count) {
    const auto& chains = arrangement_.chains;
    std::set<Link> on_border;
    for (std::size_t s = 0; s + edge_count < chains.size(); ++s)
      for (std::size_t k = 1; k < chains[s].size(); ++k)
        on_border.insert(sorted_link(chains[s][k - 1], chains[s][k]));
    for (std::size_t s = chains.size() - edge_count; s < chains.size(); ++s)
      for (std::size_t k = 1; k < chains[s].size(); ++k) {
        const Link link = sorted_link(chains[s][k - 1], chains[s][k]);
        if (!on_border.contains(link) && inside(link)) inner_.insert(link);
      }
  }

  // Inside, and not just the border itself as far as the planarity tolerance can tell.
  bool inside(const Link& link) const {
    const Vec2 a = arrangement_.points[at(link[0])], b = arrangement_.points[at(link[1])];
    const Vec2 middle = 0.5 * (a + b);
    bool odd = false, near_a = false, near_b = false, near_middle = false;
    for (const Link& segment : border_) {
      const Vec2 &p = flat_[at(segment[0])], &q = flat_[at(segment[1])];
      near_a = near_a || distance_to_segment(a, p, q) <= tolerance_.planarity;
      near_b = near_b || distance_to_segment(b, p, q) <= tolerance_.planarity;
      near_middle = near_middle || distance_to_segment(middle, p, q) <= tolerance_.planarity;
      if ((p.y() > middle.y()) == (q.y() > middle.y())) continue;
      const double x = p.x() + (middle.y() - p.y()) / (q.y() - p.y()) * (q.x() - p.x());
      if (x > middle.x()) odd = !odd;
    }
    return odd && !(near_a && near_b && near_middle);
  }

  // Border points at which contact lines end become corners of the rings, which bends them by up
  // to the planarity tolerance.
  void bend_border() {
    std::set<int> ends;
    for (const Link& link : inner_) ends.insert(link.begin(), link.end());
    for (std::size_t s = 0; s < border_.size(); ++s) {
      const auto& chain = arrangement_.chains[s];
      std::vector<int> bent = {border_[s][0]};
      for (std::size_t i = 1; i + 1 < chain.size(); ++i)
        if (ends.contains(chain[i])) bent.push_back(chain[i]);
      bent.push_back(border_[s][1]);
      bent_.push_back(std::move(bent));
    }
  }

  // Where the sides of a needle are bent, they may come to cross. There, contact lines end beside
  // the points of others, on straight sides.
  void straighten_crossings() {
    std::set<std::size_t> straight;
    for (bool is_done = false; !is_done;) {
      is_done = true;
      for (const std::size_t s : crossing_sides())
        if (bent_[s].size() > 2 && straight.insert(s).second) {
          straighten(s);
          is_done = false;
        }
    }
  }

  // Of the border: those with pieces that another side crosses.
  std::set<std::size_t> crossing_sides() const {
    std::set<std::size_t> found;
    for (std::size_t s = 0; s < bent_.size(); ++s) {
      if (bent_[s].size() == 2) continue;
      for (std::size_t t = 0; t < bent_.size(); ++t)
        if (s != t && sides_cross(bent_[s], bent_[t])) found.insert({s, t});
    }
    return found;
  }

  bool sides_cross(const std::vector<int>& side, const std::vector<int>& other) const {
    const auto& p = arrangement_.points;
    const auto box = [&](std::span<const int> run) {
      Eigen::AlignedBox2d around;
      for (const int k : run) around.extend(p[at(k)]);
      return around;
    };
    const Eigen::AlignedBox2d around_other = box(other);
    for (std::size_t i = 1; i < side.size(); ++i) {
      if (!around_other.intersects(box(std::span(side).subspan(i - 1, 2)))) continue;
      for (std::size_t j = 1; j < other.size(); ++j)
        if (crossing_depth({p[at(side[i - 1])], p[at(side[i])]},
                           {p[at(other[j - 1])], p[at(other[j])]}) > tolerance_.length)
          return true;
    }
    return false;
  }

  void straighten(std::size_t s) {
    std::vector<int>& side = bent_[s];
    const Vec2 start = arrangement_.points[at(side.front())];
    const Vec2 along = arrangement_.points[at(side.back())] - start;
    double last = 0;
    std::vector<int> straight = {side.front()};
    for (std::size_t i = 1; i + 1 < side.size(); ++i) {
      const double t = along.dot(arrangement_.points[at(side[i])] - start) / along.squaredNorm();
      if (t <= last || t >= 1) continue;
      last = t;
      moved_.emplace(side[i], static_cast<int>(arrangement_.points.size()));
      straight.push_back(static_cast<int>(arrangement_.points.size()));
      arrangement_.points.push_back(start + t * along);
    }
    straight.push_back(side.back());
    side = std::move(straight);
  }

  void update_rings() {
    std::size_t s = 0;
    for (auto& ring : draft_.rings) {
      std::vector<int> longer;
      for (std::size_t k = 0; k < ring.size(); ++k, ++s) {
        longer.push_back(ring[k]);
        for (std::size_t i = 1; i + 1 < bent_[s].size(); ++i)
          longer.push_back(ids_[at(bent_[s][i])]);
      }
      ring = std::move(longer);
    }
  }

  int end_of_contact(int point) const {
    const auto moved = moved_.find(point);
    return ids_[at(moved == moved_.end() ? point : moved->second)];
  }

  SurfaceDraft& draft_;
  std::vector<Vec3>& points_;
  LocalTolerance tolerance_;
  std::map<int, int> local_;
  std::vector<Vec2> flat_;
  std::vector<int> ids_;  // point of the arrangement → point of the scene
  std::vector<Link> border_;
  Arrangement arrangement_;
  std::set<Link> inner_;
  std::vector<std::vector<int>> bent_;  // of each side of the border: its points
  std::map<int, int> moved_;            // point of the arrangement → where a straight side has it
};

// Edges other than the surface's own that lie in its plane and may reach into it.
std::vector<SurfaceEdge> edges_in_plane(const SurfaceDraft& draft,
                                        const std::vector<SurfaceEdge>& edges, const FlatTree& tree,
                                        const std::vector<Vec3>& points) {
  const double most = tolerance_of(draft.scale).planarity;
  Bounds around;
  for (const int p : draft.rings[0]) around.include(points[at(p)]);
  around = around.grown(most);
  const Vec3 normal = draft.frame.normal, spread = normal.cwiseAbs();
  const std::vector<Link> own = links_of(draft.rings);
  std::vector<int> found;
  const auto reaches = [&](const Bounds& box) {
    return box.meets(around) &&
           std::abs(draft.frame.height(box.centre())) <= spread.dot(box.half_size()) + most;
  };
  visit_reached(tree, reaches, [&](int i) {
    const SurfaceEdge& edge = edges[at(i)];
    const double limit = tolerance_of(joint_scale(draft.scale, edge.scale)).planarity;
    const bool in_plane = std::all_of(edge.link.begin(), edge.link.end(), [&](int p) {
      return std::abs(draft.frame.height(points[at(p)])) <= limit;
    });
    if (in_plane && !std::binary_search(own.begin(), own.end(), edge.link)) found.push_back(i);
  });
  std::sort(found.begin(), found.end());
  std::vector<SurfaceEdge> result;
  for (const int i : found) result.push_back(edges[at(i)]);
  return result;
}

/// Lines in one surface cross each other, so that the pieces grow with the square of their number.
void require_few_crossings(const std::vector<std::vector<std::array<int, 2>>>& cuts) {
  double pairs = 0;
  for (const auto& lines : cuts) pairs += std::pow(static_cast<double>(lines.size()), 2) / 2;
  if (pairs > most_pairs)
    throw Error(ErrorCode::too_large, {},
                fmt::format("the {} surfaces cut through each other so often that {:.2g} pairs of "
                            "the lines may cross in them",
                            cuts.size(), pairs));
}

[[noreturn]] void refuse_pieces(std::size_t surfaces, double most) {
  throw Error(ErrorCode::too_large, {},
              fmt::format("the {} surfaces touch and cut through each other along more than {:.0f} "
                          "pieces of lines",
                          surfaces, most));
}

}  // namespace

void find_contacts(std::vector<SurfaceDraft>& drafts, std::vector<Vec3>& points, double most) {
  const std::vector<SurfaceEdge> edges = all_edges(drafts);
  std::vector<Bounds> boxes(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (const int p : edges[i].link) boxes[i].include(points[at(p)]);
  const FlatTree tree = make_flat_tree(boxes, 1);
  const auto cuts = find_intersections(drafts, points, most);
  require_few_crossings(cuts);
  double pieces = 0;
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    std::vector<SurfaceEdge> lines = edges_in_plane(drafts[i], edges, tree, points);
    for (const Link& cut : cuts[i]) lines.push_back({cut, drafts[i].scale});
    if (!lines.empty()) ContactFinder(drafts[i], points).run(lines);
    pieces += static_cast<double>(drafts[i].contacts.size());
    if (pieces > most) refuse_pieces(drafts.size(), most);
  }
}

}  // namespace halfshade
