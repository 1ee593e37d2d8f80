#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/scene.h"
#include "solver/factors/factor_scene.h"
#include "solver/factors/row_place.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace halfshade {

enum class FactorMethod {
  automatic,  ///< exact, unless that is a lot of work and rays take a fraction of it
  exact,      ///< closed forms and exactly visible parts
  rays,       ///< counted rays
  hemicube    ///< item buffers at points, as radiosity began
};

/// "auto", "exact", "rays" or "hemicube".
const char* name_of(FactorMethod method);

/// Rays of a row, unless FactorOptions::rays asks for more: a minute or so.
inline constexpr int most_rays = 100'000'000;

struct FactorOptions {
  FactorUnit unit = FactorUnit::group;
  FactorMethod method = FactorMethod::automatic;
  double tolerance = 1e-4;   ///< error allowed in an entry of F, absolute, in (0, 1)
  int max_points = 1000000;  ///< at which a pair of surfaces is looked at, at most, ≥ 1
  /// Of each row, whatever the tolerance is; pixels of hemicubes count as rays. 0: as many as the
  /// tolerance takes, up to most_rays; of pixels 10,000.
  int rays = 0;
  int hemicube_pixels = 64;  ///< along an edge, FactorMethod::hemicube, even and ≥ 2
  double sparse_below = 0;   ///< entries that cannot reach this are left out, ≥ 0
  bool enforce = false;      ///< scale A F symmetrically until rows, with space, sum to one; what
                             ///< was left out is made up for
};

/// How a matrix came about.
struct FactorReport {
  FactorMethod method = FactorMethod::exact;  ///< that it was found by, never automatic
  std::size_t clear_pairs = 0;                ///< of surfaces that nothing comes between
  std::size_t partial_pairs = 0;              ///< that something may come between
  std::size_t points = 0;                     ///< at which exactly visible parts were found
  std::size_t pairs_at_limit =
      0;  ///< that took FactorOptions::max_points, and are not exact enough
  std::size_t rays = 0;
  int rows_not_reached = 0;      ///< with an entry that is less exact than asked for
  double row_sum_error_max = 0;  ///< largest |row_sum − 1|
  double backs_max = 0;          ///< largest share that is swallowed by backs
  int backs_row = 0;             ///< which row that is of
  double sparse_below = 0;       ///< FactorOptions::sparse_below,
  std::size_t left_out = 0;      ///< how many entries are left out for it,
  double left_out_max = 0;       ///< and the largest share of a row that they were, all together
  bool is_enforced = false;      ///< rows were scaled,
  double enforced_by = 0;        ///< an entry by at most this share
  bool is_complete = true;       ///< false if stopped: there is no matrix
};

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Form factors between faces, groups or materials: F(row, column) is the share of what leaves the
/// row's surface evenly and by Lambert's law that reaches the column's.
struct FactorMatrix {
  std::vector<std::string> names;
  Eigen::ArrayXd area;     ///< squared scene units
  RowMajorMatrix factors;  ///< F; area(i) F(i,j) = area(j) F(j,i) but for rounding
  /// Share that meets no front: that leaves the scene, or is swallowed by `backs`. Found like a
  /// factor, as light that arrives at a box round the scene or at a back, not as what is missing.
  Eigen::ArrayXd space;
  Eigen::ArrayXd backs;    ///< share that is swallowed by backs of one-sided faces
  Eigen::ArrayXd row_sum;  ///< Σ F + space before anything was put right
  Eigen::ArrayXd error;  ///< of each entry of the row, absolute, space with it: an estimate on the
                         ///< safe side, see factors.md, and no proof
  /// Share that FactorOptions::sparse_below left out and nothing makes up for: Σ F + space +
  /// left_out is row_sum, or one if it was enforced. Empty if a file does not tell.
  Eigen::ArrayXd left_out;
  std::vector<RowPlace> places;  ///< by face; empty otherwise, or if a file does not tell
  std::string unit;              ///< of lengths
  std::string source;            ///< the file that it was read from; empty if it was computed
  SoundScene scene;              ///< what was repaired, and lines of faces; no more is kept of it
  FactorReport report;
};

/// Computes each pair of surfaces once: nothing for those that cannot see each other, closed forms
/// where nothing is in between, else cubature of exact point factors; or rows by rays; see
/// factors.md. No emitter is needed. Throws as make_factor_scene does, and Error(too_large) if the
/// matrix would not fit into memory or, with FactorMethod::exact, take more than a day. If stopped,
/// there is no matrix, and the report says so.
/// The same for any number of threads. Cost: n²/2 shafts for n surfaces.
FactorMatrix form_factor_matrix(const Scene& scene, const FactorOptions& options = {},
                                const Progress& progress = {});

/// Throws Error(too_large) if what goes with a matrix of so many rows would not fit into memory.
void require_factor_memory(int rows);

}  // namespace halfshade
