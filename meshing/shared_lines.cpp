#include "meshing/shared_lines.h"

#include "meshing/box_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace halfshade {
namespace {

// Receivers that share an edge lie apart there by as much as their planes do, but never by this
// share of an edge.
constexpr double largest_gap = 0.01;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Stretch {
  Vec3 from, to;
  double reach = 0;  // how far off another may lie to be the same

  double length() const { return (to - from).norm(); }
};

Stretch stretch(const Receiver& receiver, const Segment2& ends, double shortest,
                const Tolerance& tolerance) {
  return {receiver.frame.to_space(ends[0]), receiver.frame.to_space(ends[1]),
          std::max(tolerance.length, std::min(2 * tolerance.planarity, largest_gap * shortest))};
}

void collect(const SoundScene& scene, SharedLines& out, std::vector<Stretch>& stretches) {
  for (std::size_t r = 0; r < scene.receivers.size(); ++r) {
    const Receiver& receiver = scene.receivers[r];
    out.first_wall.push_back(static_cast<int>(out.walls.size()));
    const auto add = [&](const Segment2& ends, double shortest) {
      out.walls.push_back({static_cast<int>(r), ends});
      stretches.push_back(stretch(receiver, ends, shortest, scene.tolerance));
    };
    for (const Ring& ring : receiver.rings) {
      const std::size_t n = ring.size();
      const auto length = [&](std::size_t k) { return (ring[(k + 1) % n] - ring[k % n]).norm(); };
      for (std::size_t k = 0; k < n; ++k)
        add({ring[k], ring[(k + 1) % n]}, std::min({length(k + n - 1), length(k), length(k + 1)}));
    }
    for (const Segment2& contact : receiver.contacts)
      add(contact, (contact[1] - contact[0]).norm());
  }
  out.first_wall.push_back(static_cast<int>(out.walls.size()));
}

bool lie_on_each_other(const Stretch& a, const Stretch& b, double least_length) {
  if (a.length() < b.length()) return lie_on_each_other(b, a, least_length);
  if (!(b.length() > 0)) return false;
  const Vec3 direction = (a.to - a.from) / a.length();
  double t0 = direction.dot(b.from - a.from), t1 = direction.dot(b.to - a.from);
  Vec3 p0 = b.from, p1 = b.to;
  if (t0 > t1) {
    std::swap(t0, t1);
    std::swap(p0, p1);
  }
  const double begin = std::max(t0, 0.0), end = std::min(t1, a.length());
  if (!(end - begin > least_length)) return false;
  const double reach = std::min(a.reach, b.reach);
  const auto is_near = [&](double t) {
    const Vec3 p = p0 + (t - t0) / (t1 - t0) * (p1 - p0);
    return (p - (a.from + t * direction)).norm() <= reach;
  };
  return is_near(begin) && is_near(end);
}

int root(std::vector<int>& above, int i) {
  while (above[at(i)] != i) i = above[at(i)] = above[at(above[at(i)])];
  return i;
}

// For every wall the first of those it is joined to.
std::vector<int> join(const SharedLines& lines, const std::vector<Stretch>& stretches,
                      double least_length) {
  std::vector<Box> boxes;
  for (const Stretch& s : stretches) {
    boxes.emplace_back(s.from.cwiseMin(s.to), s.from.cwiseMax(s.to));
    boxes.back().min().array() -= s.reach;
    boxes.back().max().array() += s.reach;
  }
  const BoxTree tree(boxes);
  std::vector<int> above(stretches.size());
  std::iota(above.begin(), above.end(), 0);
  for (int i = 0; i < static_cast<int>(stretches.size()); ++i)
    tree.query_box(boxes[at(i)], [&](int j) {
      if (j >= i || lines.walls[at(i)].receiver == lines.walls[at(j)].receiver) return;
      const int a = root(above, i), b = root(above, j);
      if (a == b || !lie_on_each_other(stretches[at(i)], stretches[at(j)], least_length)) return;
      above[at(std::max(a, b))] = std::min(a, b);
    });
  for (int i = 0; i < static_cast<int>(above.size()); ++i) above[at(i)] = root(above, i);
  return above;
}

}  // namespace

SharedLines find_shared_lines(const SoundScene& scene) {
  SharedLines result;
  std::vector<Stretch> stretches;
  collect(scene, result, stretches);
  const std::vector<int> group = join(result, stretches, scene.tolerance.length);
  std::vector<std::vector<int>> members(group.size());
  for (std::size_t w = 0; w < group.size(); ++w)
    members[at(group[w])].push_back(static_cast<int>(w));
  for (std::vector<int>& walls : members) {
    if (walls.size() < 2) continue;
    const auto& longest =
        stretches[at(*std::max_element(walls.begin(), walls.end(), [&](int a, int b) {
          return stretches[at(a)].length() < stretches[at(b)].length();
        }))];
    SharedLine line{longest.from, (longest.to - longest.from) / longest.length(), {}};
    for (const int w : walls) {
      Wall& wall = result.walls[at(w)];
      const PlaneFrame& frame = scene.receivers[at(wall.receiver)].frame;
      wall.line = static_cast<int>(result.lines.size());
      wall.begin = along(line, frame, wall.ends[0]);
      wall.end = along(line, frame, wall.ends[1]);
    }
    line.walls = std::move(walls);
    result.lines.push_back(std::move(line));
  }
  return result;
}

double along(const SharedLine& line, const PlaneFrame& frame, const Vec2& point) {
  // Not by way of the point in space, which loses digits far from the origin.
  return line.direction.dot(frame.origin - line.origin) + point.x() * line.direction.dot(frame.e1) +
         point.y() * line.direction.dot(frame.e2);
}

}  // namespace halfshade
