#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "meshing/rays/visibility.h"

#include <Eigen/SparseCore>

#include <cstddef>
#include <vector>

namespace halfshade {

/// Symmetric: entry (i,j) is A_i F(i,j) = A_j F(j,i), in squared scene units. Row-major, both
/// halves stored, zeros left out.
using ExchangeMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

enum class Closure {
  automatic,  ///< enforce where no light gets out
  enforce,    ///< everywhere, also where openings swallow light
  leave
};

/// How form factors among elements are found.
enum class FactorsBy {
  rays,      ///< pairs by closed forms, times what rays between them find visible
  hemicube,  ///< pixels round each element's centroid, as radiosity began
  exact      ///< closed forms on exactly visible parts at six points of each element
};

struct ExchangeOptions {
  FactorsBy factors = FactorsBy::rays;
  int hemicube_pixels = 64;  ///< along an edge, even and ≥ 2; of hemicubes
  double tolerance = 1e-4;   ///< relative error of an unobstructed form factor, in (0, 1)
  int rays_per_pair = 16;  ///< visibility samples for a pair of elements of mean form factor, ≥ 1
  Closure closure = Closure::automatic;
};

struct ExchangeReport {
  FactorsBy by = FactorsBy::rays;
  std::size_t factors = 0;  ///< non-zero entries of the matrix
  std::size_t rays = 0;
  bool closed = false;  ///< no light gets out: rows of F should sum to 1 wherever light gets to
  bool closure_enforced = false;
  std::size_t refined_rows = 0;  ///< rows of closed enclosures that took more rays
  /// Closed enclosures whose rows are so far off all the same that they stay as they are: what is
  /// missing there is lost.
  int unfinished = 0;
  double closure_error_max =
      0;  ///< max |1 − Σ_j F(i,j)| before enforcement, over closed enclosures
  double closure_error_rms = 0;  ///< the same, root of the area-weighted mean square
  double escaping_fraction = 0;  ///< area-weighted mean of 1 − Σ_j F(i,j) over lit enclosures
  bool complete = true;          ///< false if interrupted
  /// Of the exchange of light, Σ A_i F(i,j) of pairs that an interrupt left to rays, see
  /// estimate_factors; 0 if complete.
  double estimated_share = 0;
};

/// The groups of elements that exchange light with each other.
struct Enclosures {
  std::vector<int> of_element;  ///< element → enclosure
  std::vector<bool> closed;  ///< enclosure → no light leaves it, so that its rows of F sum to 1
  std::vector<bool> lit;     ///< enclosure → something in it emits

  int count() const { return static_cast<int>(closed.size()); }
  bool is_closed(int element) const { return closed[group(element)]; }
  bool is_lit(int element) const { return lit[group(element)]; }

 private:
  std::size_t group(int element) const {
    return static_cast<std::size_t>(of_element[static_cast<std::size_t>(element)]);
  }
};

struct Exchange {
  ExchangeMatrix matrix;
  ExchangeMatrix variance;  ///< of entries that are estimates; empty if none are
  Eigen::ArrayXd area;      ///< A_i
  /// A_i times the share of what leaves i that meets nothing; exactly 0 where closure is enforced.
  /// Errors of factors may make it negative.
  Eigen::ArrayXd lost;
  Enclosures enclosures;
  ExchangeReport report;
};

/// Computes A_i F(i,j) for all pairs of elements, and none for elements in different cells of
/// space. By rays, each pair is computed once, so that reciprocity holds by construction; else it
/// is the mean of what the two elements find, see factors_from_points. Rows of closed enclosures
/// that are off get more rays, and are only scaled once they are near; see enforce_closure. Throws
/// Error(too_large) if the matrix would not fit into the machine's memory. If stopped on the way,
/// rows not yet reached are estimated; if stopped before, they stay empty. Cost: n²/2 factors for n
/// elements, or n hemicubes; 12 bytes a non-zero.
Exchange compute_exchange(const SoundScene& scene, const ElementTable& elements,
                          const VisibilityIndex& visibility, const ExchangeOptions& options = {},
                          const Progress& progress = {});

/// An exchange without any factors, for scenes where nothing reflects: what is left is which
/// elements are closed in together. What is not closed loses everything.
Exchange enclosures_alone(const SoundScene& scene, const ElementTable& elements);

/// Scales the matrix from both sides, S M S with S diagonal and positive, until every row i that is
/// `wanted` sums to area[i]: the symmetric form of Sinkhorn's scaling, found by Newton's method to
/// rounding error. Keeps symmetry, sign and sparsity. Returns false, and leaves the matrix alone,
/// where no such scaling is found. Rows without entries are left out.
bool enforce_closure(ExchangeMatrix& matrix, const Eigen::ArrayXd& area,
                     const std::vector<bool>& wanted);

}  // namespace halfshade
