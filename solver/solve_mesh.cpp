#include "solver/solve_mesh.h"

#include "meshing/core/error.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace halfshade {
namespace {

/// Numbers of elements that differ by less than this share count as equal.
constexpr double near_enough = 0.1;

double first_length(const SoundScene& scene, const SolveOptions& options) {
  return options.max_length > 0 ? options.max_length : length_for_count(scene, options.elements);
}

/// Nothing if it takes far too many triangles.
std::optional<SolveMesh> try_mesh(const SoundScene& scene, const Discontinuities& found,
                                  const DiscontinuityMeshOptions& options,
                                  const Progress& progress) {
  try {
    const DiscontinuityMesh mesh = mesh_discontinuities(scene, found, options, progress);
    return SolveMesh{mesh.patches.elements(), mesh.report, 0};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::too_large) return std::nullopt;
    throw;
  }
}

/// How the length and the tolerance come to suit the number of elements asked for.
class SizeSearch {
 public:
  SizeSearch(const SoundScene& scene, const SolveOptions& options)
      : wanted_(options.elements),
        most_(options.max_length > 0 ? options.max_elements
                                     : std::min(options.max_elements, 2 * options.elements)),
        is_fixed_(options.max_length > 0),
        length(first_length(scene, options)),
        tolerance(options.tolerance) {}

  bool is_too_many(double count) const { return count > most_; }

  /// Changes length or tolerance after they gave `count` elements; false if there is no need.
  bool improve(double count) {
    const double excess = count / wanted_;
    // Longer elements do not help where curves are what makes them many.
    const bool stuck = is_fixed_ || (last_ > 0 && count > (1 - near_enough) * last_);
    last_ = count;
    if (count > most_ && stuck) {
      tolerance = std::max(smallest_raised, raise * tolerance);
      last_ = 0;
      return true;
    }
    if (is_fixed_ || std::abs(excess - 1) <= near_enough || (excess > 1 && stuck)) return false;
    length *= std::sqrt(excess);
    return true;
  }

 private:
  static constexpr double raise = 4, smallest_raised = 0.01;

  double wanted_, most_;
  bool is_fixed_;
  double last_ = 0;  ///< elements before the last change of the length

 public:
  double length, tolerance;
};

}  // namespace

SolveMesh make_solve_mesh(const SoundScene& scene, const SolveOptions& options,
                          const Progress& progress) {
  constexpr int attempts = 5;
  PlanarMeshOptions mesh_options;
  mesh_options.max_triangles = static_cast<std::size_t>(options.max_elements);
  mesh_options.max_length = first_length(scene, options);
  SolveMesh mesh;
  mesh.elements = PatchMesh(scene, mesh_options, progress).elements();
  if (options.max_length > 0 || progress.stopped()) return mesh;
  for (int k = 1; k < attempts; ++k) {
    const double excess = mesh.elements.count() / static_cast<double>(options.elements);
    if (std::abs(excess - 1) <= near_enough) break;
    mesh_options.max_length *= std::sqrt(excess);
    mesh.elements = PatchMesh(scene, mesh_options, progress).elements();
  }
  return mesh;
}

SolveMesh make_solve_mesh(const SoundScene& scene, const Discontinuities& found,
                          const SolveOptions& options, double mean_irradiance,
                          const Progress& progress) {
  constexpr int attempts = 10;
  SizeSearch search(scene, options);
  std::optional<SolveMesh> best;
  DiscontinuityMeshOptions mesh_options;
  // Some more than would do, so that a mesh that ended early is known by its size.
  mesh_options.max_triangles = 4 * static_cast<std::size_t>(options.max_elements);
  for (int k = 0; k < attempts; ++k) {
    mesh_options.max_length = search.length;
    mesh_options.irradiance_tolerance = search.tolerance * mean_irradiance;
    const double tolerance = search.tolerance;
    std::optional<SolveMesh> mesh = try_mesh(scene, found, mesh_options, progress);
    const double count = mesh ? mesh->elements.count() : 2. * options.max_elements;
    const bool fits = mesh && !search.is_too_many(count);
    if (fits) {
      best = std::move(mesh);
      best->tolerance = tolerance;
    }
    if (progress.stopped() || !search.improve(count)) break;
  }
  if (best) return *std::move(best);
  SolveMesh plain = make_solve_mesh(scene, options, progress);
  plain.report.culled = found.curves.size();
  return plain;
}

}  // namespace halfshade
