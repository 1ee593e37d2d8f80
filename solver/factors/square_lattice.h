#pragma once

#include "meshing/core/types.h"

#include <array>
#include <cstddef>
#include <vector>

namespace halfshade {

/// Points of the unit square for the cubature of functions with kinks: a lattice, folded at the
/// middle of both sides so that what is not periodic is as good as what is: errors shrink like N^-2
/// for smooth functions, and along kinks that are parallel to a side, too (Hickernell 2002).
struct SquareLattice {
  /// A place to look at, and the linear extrapolation to it from lattice points nearest to it: what
  /// a function is off by there tells how far it is from linear between the points.
  struct Watch {
    static constexpr std::size_t count = 6;
    std::array<int, count> near;
    std::array<double, count> weight;
  };
  std::vector<Vec2> places;      ///< the first half of them is the lattice before
  std::vector<Watch> inner;      ///< of each place, from the others
  std::array<Watch, 4> corners;  ///< (0, 0), (1, 0), (1, 1), (0, 1), a little inside

  static constexpr double inset = 1e-4;
  Vec2 corner(std::size_t k) const {
    const double low = inset, high = 1 - inset;
    return {k == 1 || k == 2 ? high : low, k >= 2 ? high : low};
  }
};

/// A quadrilateral that they are laid on; a triangle has two corners in one place.
using Quad = std::array<Vec3, 4>;

/// So many lattices there are, of 16, 32, ... 262,144 places.
constexpr std::size_t lattice_levels = 15;
constexpr std::size_t places_of_lattice(std::size_t level) { return std::size_t{16} << level; }

/// Few of them, and as many as there are: pairs that few do not suffice for are better off with
/// cells, if these come to an end.
constexpr std::size_t few_lattice_places = 4096;
constexpr std::size_t most_lattice_places = places_of_lattice(lattice_levels - 1);

/// Each holds the one before (Hickernell, Hong, L'Ecuyer and Lemieux 2000), so that no look is lost
/// where more are needed. It is made when it is first asked for, by any thread, which takes some
/// two microseconds a place, and kept. Precondition: `level` < lattice_levels.
const SquareLattice& square_lattice(std::size_t level);

}  // namespace halfshade
