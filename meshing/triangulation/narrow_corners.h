#pragma once

#include "meshing/triangulation/constrained_mesh.h"

#include <compare>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace halfshade {

/// Where constraints of a mesh meet at less than 60°. Constraints that continue each other count as
/// one, so that points on a constraint do not hide the corners at its ends.
class NarrowCorners {
 public:
  explicit NarrowCorners(const ConstrainedMesh& mesh);

  /// Whether the constraint `constraint` ends in a narrow corner at a point of the original mesh.
  bool is_narrow_at(int constraint, int point) const;

  /// Whether two points, of which the second of each pair says on which constraint it was added to
  /// the mesh (−1 for an original point), lie on the legs of a narrow corner, equally far from it.
  /// An edge between them is as short as the corner makes it (Shewchuk 2002).
  bool are_twins(const ConstrainedMesh& mesh, int a, int constraint_of_a, int b,
                 int constraint_of_b) const;

 private:
  struct End {  // of a constraint
    int point;
    double direction;
    int constraint;
    auto operator<=>(const End&) const = default;
  };
  std::vector<End> list_ends(const ConstrainedMesh& mesh);
  std::size_t opposite(const std::vector<End>& ends, std::size_t i) const;
  void unite_straight_constraints(const ConstrainedMesh& mesh);
  void find_corners(const ConstrainedMesh& mesh);
  void constraints_at(int point, int constraint, std::vector<int>& constraints) const;

  std::vector<int> chain_;                         // [constraint] the chain it is part of
  std::vector<int> first_, constraints_;           // [point] its constraints
  std::unordered_map<std::uint64_t, int> corner_;  // by two chains: a point
  std::vector<std::uint64_t> narrow_;              // by constraint and point; sorted
};

}  // namespace halfshade
