#include "meshing/event_evidence.h"

#include <algorithm>
#include <map>

namespace halfshade {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A place where one edge of the group follows another.
using Corner2 = std::array<int, 2>;

/// The pieces of one side with their followers.
class Side {
 public:
  Side(const SideView& view, std::span<const int> group) : view_(view) {
    const auto& pieces = view.part.pieces;
    next_.resize(pieces.size());
    int first = 0;
    for (const int end : view.part.chain_ends) {
      for (int i = first; i < end; ++i) next_[at(i)] = i + 1 < end ? i + 1 : first;
      first = end;
    }
    for (int i = 0; i < static_cast<int>(pieces.size()); ++i) {
      const Corner2 corner = {pieces[at(i)].edge, pieces[at(next_[at(i)])].edge};
      if (corner[0] != corner[1] && contains(group, corner[0]) && contains(group, corner[1]))
        corners_[corner].push_back(i);
    }
  }

  /// Marks the corners that the other side has fewer of.
  std::vector<bool> surplus(const Side& other) const {
    std::vector<bool> marked(next_.size(), false);
    for (const auto& [corner, places] : corners_) {
      const auto same = other.corners_.find(corner);
      const std::size_t there = same == other.corners_.end() ? 0 : same->second.size();
      for (std::size_t k = there; k < places.size(); ++k) marked[at(places[k])] = true;
    }
    return marked;
  }

  /// Triples that the chains of marked corners are made of: a chain a, b1, b2, …, c differs from
  /// the corner a, c by the triangles a b1 b2, a b2 b3, ….
  void add_triples(const std::vector<bool>& marked, int sign, std::vector<EdgeTriple>& out) const {
    std::vector<bool> done(marked.size(), false);
    const auto run_from = [&](int start) {
      std::vector<int> run = {start};
      for (int i = start; marked[at(i)] && !done[at(i)]; i = next_[at(i)]) {
        done[at(i)] = true;
        run.push_back(next_[at(i)]);
      }
      if (run.size() > 1 && run.back() == start) run.pop_back();
      for (std::size_t k = 2; k < run.size(); ++k) {
        const int turn = turns_left(run[0], run[k]) ? -1 : 1;
        out.push_back({{edge(run[0]), edge(run[k - 1]), edge(run[k])}, sign * turn});
      }
    };
    std::vector<bool> follows(marked.size(), false);
    for (std::size_t i = 0; i < marked.size(); ++i)
      if (marked[i]) follows[at(next_[i])] = true;
    for (std::size_t i = 0; i < marked.size(); ++i)
      if (marked[i] && !follows[i]) run_from(static_cast<int>(i));
    for (std::size_t i = 0; i < marked.size(); ++i)  // closed chains
      if (marked[i] && !done[i]) run_from(static_cast<int>(i));
  }

 private:
  static bool contains(std::span<const int> group, int edge) {
    return std::binary_search(group.begin(), group.end(), edge);
  }
  int edge(int piece) const { return view_.part.pieces[at(piece)].edge; }

  /// Whether the boundary would turn left where it went from piece a straight on to piece b.
  bool turns_left(int a, int b) const {
    const auto& pieces = view_.part.pieces;
    const auto plane = [&](const BoundaryPiece& piece) -> Vec3 {
      return (piece.from - view_.point).cross(piece.to - view_.point);
    };
    const Vec3 towards = pieces[at(a)].to - view_.point;
    return plane(pieces[at(a)]).cross(plane(pieces[at(b)])).dot(towards) < 0;
  }

  const SideView& view_;
  std::vector<int> next_;
  std::map<Corner2, std::vector<int>> corners_;
};

}  // namespace

EventEvidence compare_sides(const SideView& left, const SideView& right,
                            std::span<const int> group) {
  const Side a(left, group), b(right, group);
  const std::vector<bool> only_left = a.surplus(b), only_right = b.surplus(a);
  EventEvidence evidence;
  const auto any = [](const std::vector<bool>& marks) {
    return std::find(marks.begin(), marks.end(), true) != marks.end();
  };
  evidence.differs = any(only_left) || any(only_right);
  if (!evidence.differs) return evidence;
  a.add_triples(only_left, 1, evidence.triples);
  b.add_triples(only_right, -1, evidence.triples);
  return evidence;
}

}  // namespace halfshade
