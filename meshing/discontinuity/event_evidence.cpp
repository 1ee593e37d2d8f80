#include "meshing/discontinuity/event_evidence.h"

#include <algorithm>
#include <map>

namespace halfshade {
namespace {

/// A place where one edge of the group follows another.
struct Joint {
  EdgeId from, to;
  Vec3 plane, onto;  ///< normals of the planes of the point and the pieces that meet
  Vec3 towards;      ///< direction from the point
  auto key() const { return std::array{from, to}; }
};

std::vector<Joint> joints_of(const SideView& view, std::span<const EdgeId> group) {
  std::vector<Joint> joints;
  const auto& pieces = view.part.pieces;
  const auto is_in_group = [&](EdgeId edge) {
    return std::binary_search(group.begin(), group.end(), edge);
  };
  const auto plane = [&](const BoundaryPiece& piece) -> Vec3 {
    return (piece.from - view.point).cross(piece.to - view.point);
  };
  int first = 0;
  for (const int end : view.part.chain_ends) {
    for (int i = first; i < end; ++i) {
      const BoundaryPiece &here = pieces[at(i)], &next = pieces[at(i + 1 < end ? i + 1 : first)];
      if (here.edge != next.edge && is_in_group(here.edge) && is_in_group(next.edge))
        joints.push_back({here.edge, next.edge, plane(here), plane(next), here.to - view.point});
    }
    first = end;
  }
  std::stable_sort(joints.begin(), joints.end(),
                   [](const Joint& a, const Joint& b) { return a.key() < b.key(); });
  return joints;
}

/// What a list has more of than another; both sorted.
std::vector<Joint> surplus(const std::vector<Joint>& list, const std::vector<Joint>& other) {
  std::vector<Joint> result;
  std::set_difference(list.begin(), list.end(), other.begin(), other.end(),
                      std::back_inserter(result),
                      [](const Joint& a, const Joint& b) { return a.key() < b.key(); });
  return result;
}

/// The edge that most joints have a part in.
EdgeId busiest_edge(const std::vector<Joint>& left, const std::vector<Joint>& right) {
  std::map<EdgeId, int> uses;
  for (const auto* joints : {&left, &right})
    for (const Joint& joint : *joints) {
      ++uses[joint.from];
      ++uses[joint.to];
    }
  return std::max_element(uses.begin(), uses.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

/// A plane of the point and the edge `edge`, from whichever joint has it.
Vec3 plane_of(EdgeId edge, const std::vector<Joint>& left, const std::vector<Joint>& right) {
  for (const auto* joints : {&left, &right})
    for (const Joint& joint : *joints) {
      if (joint.from == edge) return joint.plane;
      if (joint.to == edge) return joint.onto;
    }
  return Vec3::Zero();
}

/// +1 if directions on the emitter, given by the planes they span with the point, turn left.
int turn(const Vec3& a, const Vec3& b, const Vec3& towards) {
  return a.cross(b).dot(towards) < 0 ? 1 : -1;
}

}  // namespace

// The area of the visible part is a sum over its joints of terms [a,b] that depend smoothly on the
// point, with [a,b] + [b,a] = 0, and [a,r] + [r,b] − [a,b] = ± the triangle between a, r and b; the
// sign is −(turn a to r)(turn r to b)(turn a to b). With one edge r for all, the difference between
// the sides, in which every edge is left as often as it is entered, is a sum of such triangles.
EventEvidence compare_sides(const SideView& left, const SideView& right,
                            std::span<const EdgeId> group) {
  const std::vector<Joint> all_left = joints_of(left, group), all_right = joints_of(right, group);
  const std::vector<Joint> only_left = surplus(all_left, all_right);
  const std::vector<Joint> only_right = surplus(all_right, all_left);
  EventEvidence evidence;
  evidence.differs = !only_left.empty() || !only_right.empty();
  if (!evidence.differs) return evidence;
  const EdgeId middle = busiest_edge(only_left, only_right);
  const Vec3 plane = plane_of(middle, only_left, only_right);
  const auto add = [&](const Joint& joint, int sign) {
    if (joint.from == middle || joint.to == middle) return;
    EdgeTriple triple{{joint.from, middle, joint.to},
                      sign * turn(joint.plane, plane, joint.towards) *
                          turn(plane, joint.onto, joint.towards) *
                          turn(joint.plane, joint.onto, joint.towards)};
    std::sort(triple.edges.begin(), triple.edges.end());
    evidence.triples.push_back(triple);
  };
  for (const Joint& joint : only_left) add(joint, 1);
  for (const Joint& joint : only_right) add(joint, -1);
  return evidence;
}

}  // namespace halfshade
