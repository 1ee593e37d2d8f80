#include "meshing/triangulation/length_bisection.h"

#include <map>
#include <queue>
#include <set>

namespace halfshade {
namespace {

using Link = std::array<int, 2>;

Link sorted(int a, int b) { return a < b ? Link{a, b} : Link{b, a}; }

class Bisector {
 public:
  explicit Bisector(PlanarMesh& mesh)
      : mesh_(mesh), constrained_(mesh.constrained_edges.begin(), mesh.constrained_edges.end()) {}

  void run(double max_length, std::size_t max_triangles) {
    limit_ = max_length * max_length;
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& c = mesh_.triangles[static_cast<std::size_t>(t)];
        triangles_[sorted(c[k], c[(k + 1) % 3])].push_back(t);
      }
    for (const auto& [link, sides] : triangles_) enqueue(link);
    while (!queue_.empty()) {
      if (mesh_.triangles.size() >= max_triangles) {
        mesh_.complete = false;
        break;
      }
      const Link link = queue_.top().second;
      queue_.pop();
      split(link);
    }
    mesh_.constrained_edges.assign(constrained_.begin(), constrained_.end());
  }

 private:
  void enqueue(const Link& link) {
    const double squared = (mesh_.points[static_cast<std::size_t>(link[1])] -
                            mesh_.points[static_cast<std::size_t>(link[0])])
                               .squaredNorm();
    if (squared > limit_) queue_.emplace(squared, link);
  }

  void split(const Link& link) {
    const auto [p, q] = link;
    const int m = static_cast<int>(mesh_.points.size());
    mesh_.points.push_back(0.5 * (mesh_.points[static_cast<std::size_t>(p)] +
                                  mesh_.points[static_cast<std::size_t>(q)]));
    const std::vector<int> sides = triangles_[link];
    triangles_.erase(link);
    for (const int t : sides) split_triangle(t, link, m);
    if (constrained_.erase(link) > 0) {
      constrained_.insert(sorted(p, m));
      constrained_.insert(sorted(q, m));
    }
    enqueue(sorted(p, m));
    enqueue(sorted(q, m));
  }

  void split_triangle(int t, const Link& link, int m) {
    auto& corners = mesh_.triangles[static_cast<std::size_t>(t)];
    std::size_t k = 0;
    while (sorted(corners[k], corners[(k + 1) % 3]) != link) ++k;
    const int a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
    const int added = static_cast<int>(mesh_.triangles.size());
    corners = {a, m, c};
    mesh_.triangles.push_back({m, b, c});
    for (int& side : triangles_[sorted(b, c)])
      if (side == t) side = added;
    triangles_[sorted(a, m)].push_back(t);
    triangles_[sorted(m, b)].push_back(added);
    triangles_[sorted(m, c)] = {t, added};
    enqueue(sorted(m, c));
  }

  PlanarMesh& mesh_;
  std::set<Link> constrained_;
  std::map<Link, std::vector<int>> triangles_;
  std::priority_queue<std::pair<double, Link>> queue_;
  double limit_ = 0;
};

}  // namespace

void bisect_long_edges(PlanarMesh& mesh, double max_length, std::size_t max_triangles) {
  if (max_length > 0) Bisector(mesh).run(max_length, max_triangles);
}

}  // namespace halfshade
