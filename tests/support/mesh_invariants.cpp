#include "tests/support/mesh_invariants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace halfshade::test {

std::pair<double, double> angle_and_length(const PlanarMesh& mesh) {
  double angle = 180, length = 0;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2& a = mesh.points[static_cast<std::size_t>(t[k])];
      const Vec2 u = mesh.points[static_cast<std::size_t>(t[(k + 1) % 3])] - a;
      const Vec2 v = mesh.points[static_cast<std::size_t>(t[(k + 2) % 3])] - a;
      angle = std::min(angle, std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v)) * 180 / M_PI);
      length = std::max(length, u.norm());
    }
  return {angle, length};
}

void expect_sound(const PlanarMesh& mesh, const std::vector<Ring>& rings,
                  const std::vector<Segment2>& contacts) {
  std::map<std::pair<int, int>, int> directed;
  std::set<int> used;
  double area = 0, border = 0;
  for (const auto& t : mesh.triangles) {
    Ring corners;
    for (std::size_t k = 0; k < 3; ++k) {
      used.insert(t[k]);
      ++directed[{t[k], t[(k + 1) % 3]}];
      corners.push_back(mesh.points[static_cast<std::size_t>(t[k])]);
    }
    EXPECT_GT(signed_area(corners), 0);
    area += signed_area(corners);
  }
  EXPECT_NEAR(area / area_of(rings), 1, 1e-12);
  std::set<std::pair<int, int>> edges;
  for (const auto& [edge, count] : directed) {
    EXPECT_EQ(count, 1) << "two triangles on one side of an edge";
    edges.insert(std::minmax(edge.first, edge.second));
    if (!directed.contains({edge.second, edge.first}))
      border += (mesh.points[static_cast<std::size_t>(edge.second)] -
                 mesh.points[static_cast<std::size_t>(edge.first)])
                    .norm();
  }
  EXPECT_NEAR(border / perimeter_of(rings), 1, 1e-12) << "T-vertices or gaps";
  EXPECT_EQ(used.size(), mesh.points.size());
  EXPECT_EQ(static_cast<int>(used.size()) - static_cast<int>(edges.size()) +
                static_cast<int>(mesh.triangles.size()),
            2 - static_cast<int>(rings.size()));
  double constrained = 0;
  EXPECT_TRUE(std::is_sorted(mesh.constrained_edges.begin(), mesh.constrained_edges.end()));
  for (const auto& [a, b] : mesh.constrained_edges) {
    EXPECT_TRUE(edges.contains({a, b}));
    constrained +=
        (mesh.points[static_cast<std::size_t>(b)] - mesh.points[static_cast<std::size_t>(a)])
            .norm();
  }
  EXPECT_NEAR(constrained / (perimeter_of(rings) + length_of(contacts)), 1, 1e-12);
}

void expect_sound(const ElementTable& table, const SoundScene& scene) {
  using Place = std::array<double, 3>;
  const auto place = [&](int p) {
    const Vec3& x = table.points[static_cast<std::size_t>(p)];
    return Place{x.x(), x.y(), x.z()};
  };
  std::vector<double> area(scene.surfaces.size(), 0), walls = area, unmatched = area;
  std::vector<std::map<std::pair<Place, Place>, int>> directed(scene.surfaces.size());
  for (int e = 0; e < table.count(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    const auto r = static_cast<std::size_t>(table.surface[i]);
    const auto t = table.triangle(e);
    const Vec3 twice = (t[1] - t[0]).cross(t[2] - t[0]);
    ASSERT_NEAR(table.area[i], 0.5 * twice.norm(), 1e-12 * table.area[i]);
    EXPECT_GT(twice.normalized().dot(table.normal[i]), 1 - 1e-6);
    area[r] += table.area[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const int p = table.corners[i][k], q = table.corners[i][(k + 1) % 3];
      EXPECT_TRUE(directed[r].emplace(std::pair(place(p), place(q)), e).second);
      const int other = table.neighbours[i][k];
      if (other < 0) {
        walls[r] += (t[(k + 1) % 3] - t[k]).norm();
        continue;
      }
      const auto& back = table.corners[static_cast<std::size_t>(other)];
      bool found = false;
      for (std::size_t j = 0; j < 3; ++j)
        found = found || (back[j] == q && back[(j + 1) % 3] == p &&
                          table.neighbours[static_cast<std::size_t>(other)][j] == e);
      EXPECT_TRUE(found) << "neighbours disagree";
    }
  }
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
    const Surface& surface = scene.surfaces[r];
    for (const auto& [edge, e] : directed[r])
      if (!directed[r].contains({edge.second, edge.first}))
        unmatched[r] += (Vec3(edge.second.data()) - Vec3(edge.first.data())).norm();
    const double border = perimeter_of(surface.rings);
    const double whole = area_of(surface.rings);
    // Points far from the origin are rounded to its grid.
    const double rounding = surface.frame.origin.lpNorm<Eigen::Infinity>() * 0x1p-52;
    EXPECT_NEAR(area[r] / whole, 1, 1e-12 + rounding * border / whole);
    EXPECT_NEAR(unmatched[r] / border, 1, 1e-9) << "T-vertices or gaps";
    EXPECT_NEAR(walls[r] / (border + 2 * length_of(surface.contacts)), 1, 1e-9);
  }
}

int expect_alike_across_surfaces(const ElementTable& table, const SoundScene& scene, double near) {
  struct Wall {
    int surface;
    Vec3 low, high, a, b;
  };
  if (near == 0) near = 1e-9 * scene.diagonal;
  std::vector<Wall> walls;
  for (int e = 0; e < table.count(); ++e)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(e);
      if (table.neighbours[i][k] >= 0) continue;
      const auto t = table.triangle(e);
      Vec3 a = t[k], b = t[(k + 1) % 3];
      if (std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3))
        std::swap(a, b);
      walls.push_back({table.surface[i], a.cwiseMin(b), a.cwiseMax(b), a, b});
    }
  std::sort(walls.begin(), walls.end(),
            [](const Wall& v, const Wall& w) { return v.low.x() < w.low.x(); });
  int pairs = 0, differing = 0;
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size(); ++j) {
      const Wall &v = walls[i], &w = walls[j];
      if (w.low.x() > v.high.x() + near) break;
      if (v.surface == w.surface) continue;
      if ((w.low.array() > v.high.array() + near || v.low.array() > w.high.array() + near).any())
        continue;
      const double length = (v.b - v.a).norm();
      const Vec3 along = (v.b - v.a) / length;
      const double s = along.dot(w.a - v.a), t = along.dot(w.b - v.a);
      if (std::min(std::max(s, t), length) - std::max(std::min(s, t), 0.0) <= near) continue;
      if ((w.a - v.a - s * along).norm() > near || (w.b - v.a - t * along).norm() > near) continue;
      ++pairs;
      if (v.a != w.a || v.b != w.b) ++differing;
    }
  EXPECT_EQ(differing, 0) << "of " << pairs << " pairs of edges that lie on each other";
  return pairs;
}

}  // namespace halfshade::test
