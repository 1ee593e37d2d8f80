#include "solver/pipeline/solve_mesh.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace halfshade {
namespace {

/// Numbers of elements that differ by less than this share count as equal.
constexpr double near_enough = 0.1;
/// Share by which a mesh may have more elements than asked for, or than the geometry takes.
constexpr double most_excess = 0.25;

double first_length(const SoundScene& scene, const SolveOptions& options) {
  return options.max_length > 0 ? options.max_length : length_for_count(scene, options.elements);
}

/// Nothing if it takes far too many triangles.
std::optional<SolveMesh> try_mesh(const SoundScene& scene, const Discontinuities& found,
                                  const DiscontinuityMeshOptions& options,
                                  const Progress& progress) {
  try {
    DiscontinuityMesh mesh = mesh_discontinuities(scene, found, options, progress);
    ElementTable elements = mesh.patches.elements();
    return SolveMesh{std::move(elements), mesh.report, 0, std::move(mesh.patches),
                     options.min_angle};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::too_large) return std::nullopt;
    throw;
  }
}

std::size_t count_contacts(const SoundScene& scene) {
  std::size_t contacts = 0;
  for (const Surface& surface : scene.surfaces) contacts += surface.contacts.size();
  return contacts;
}

[[noreturn]] void refuse(const SoundScene& scene, const SolveOptions& options) {
  throw Error(ErrorCode::too_large, {},
              fmt::format("{} surfaces with {} contact lines take more than {} elements{}; "
                          "--max-elements allows more",
                          scene.surfaces.size(), count_contacts(scene), options.max_elements,
                          options.max_length > 0
                              ? fmt::format(" of at most {} in length", options.max_length)
                              : ""));
}

/// The elements asked for and some more, or what it takes without curves and some more.
double most_elements(int asked, int plain) {
  const double most = (1 + most_excess) * asked;
  return plain <= most ? most : (1 + most_excess) * plain;
}

/// How the length and the tolerance come to suit the number of elements asked for. Works with the
/// inverse square of the length, which the number of elements is nearly linear in: curves make some
/// of their own, whatever the length.
class SizeSearch {
 public:
  /// `plain` is how many elements it takes without curves.
  SizeSearch(const SoundScene& scene, const SolveOptions& options, int plain)
      : wanted_(std::max(options.elements, plain)),
        most_(options.max_length > 0
                  ? options.max_elements
                  : std::min<double>(options.max_elements, most_elements(options.elements, plain))),
        is_fixed_(options.max_length > 0),
        longest_(longest_edge(scene, options)),
        density_(1 / std::pow(first_length(scene, options), 2)),
        tolerance_(options.tolerance) {}

  double length() const { return 1 / std::sqrt(density_); }
  double tolerance() const { return tolerance_; }
  bool is_too_many(double count) const { return count > most_; }
  double distance(double count) const { return std::abs(count - wanted_); }

  /// Changes length or tolerance after they gave `count` elements; false if there is no need or no
  /// way.
  bool improve(double count) {
    const bool is_longest = is_fixed_ || length() >= (1 - near_enough) * longest_;
    if (is_too_many(count) && is_longest && raises_++ < most_raises) {
      tolerance_ = std::max(smallest_raised, raise * tolerance_);
      last_count_ = 0;
      return true;
    }
    if (is_fixed_ || distance(count) <= near_enough * wanted_) return false;
    if ((count > wanted_ && is_longest) || changes_++ == most_changes) return false;
    double slope = (count - last_count_) / (density_ - last_density_);
    if (last_count_ == 0 || !(slope > 0) || !std::isfinite(slope)) slope = count / density_;
    last_count_ = count;
    last_density_ = density_;
    density_ = std::clamp(density_ + (wanted_ - count) / slope, density_ / most_at_once,
                          density_ * most_at_once);
    density_ = std::max(density_, 1 / (longest_ * longest_));
    return true;
  }

 private:
  static constexpr double raise = 4, smallest_raised = 0.01;
  static constexpr double most_at_once = 4;
  static constexpr int most_raises = 8, most_changes = 5;

  double wanted_, most_;
  bool is_fixed_;
  double longest_, density_, tolerance_;
  int raises_ = 0, changes_ = 0;
  double last_count_ = 0, last_density_ = 0;  ///< before the last change; 0: none to learn from
};

/// Nothing if it takes too many elements.
std::optional<SolveMesh> try_plainly(const SoundScene& scene, const PlanarMeshOptions& options,
                                     const Progress& progress) {
  try {
    PatchMesh patches(scene, options, progress);
    ElementTable elements = patches.elements();
    return SolveMesh{std::move(elements), {}, 0, std::move(patches), options.min_angle};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::too_large) return std::nullopt;
    throw;
  }
}

/// With the length that comes nearest to the number of elements asked for, or that is asked for.
std::optional<SolveMesh> mesh_near(const SoundScene& scene, const SolveOptions& options,
                                   double min_angle, const Progress& progress) {
  constexpr int attempts = 5;
  PlanarMeshOptions mesh_options;
  mesh_options.min_angle = min_angle;
  mesh_options.max_triangles = static_cast<std::size_t>(options.max_elements);
  mesh_options.max_length = first_length(scene, options);
  std::optional<SolveMesh> mesh = try_plainly(scene, mesh_options, progress);
  for (int k = 1; mesh && k < attempts && options.max_length == 0 && !progress.stopped(); ++k) {
    const double excess = mesh->elements.count() / static_cast<double>(options.elements);
    if (std::abs(excess - 1) <= near_enough) break;
    mesh_options.max_length *= std::sqrt(excess);
    mesh = try_plainly(scene, mesh_options, progress);
  }
  return mesh;
}

bool is_few_enough(const SolveMesh& mesh, const SolveOptions& options) {
  return options.max_length > 0 || mesh.elements.count() <= (1 + most_excess) * options.elements;
}

}  // namespace

PatchMesh mesh_plainly(const SoundScene& scene, const PlanarMeshOptions& mesh_options,
                       const SolveOptions& options, const Progress& progress) {
  std::optional<SolveMesh> mesh = try_plainly(scene, mesh_options, progress);
  if (!mesh) refuse(scene, options);
  return *std::move(mesh->patches);
}

// Every surface takes an element, and every contact line two sides of three.
std::size_t least_elements(const SoundScene& scene) {
  return std::max(scene.surfaces.size(), 2 * count_contacts(scene) / 3);
}

void require_few_surfaces(const SoundScene& scene, const SolveOptions& options) {
  if (least_elements(scene) > static_cast<std::size_t>(options.max_elements))
    refuse(scene, options);
}

double longest_edge(const SoundScene& scene, const SolveOptions& options) {
  // What curves can do is judged for elements as long as allowed, so length is no way to have
  // fewer.
  constexpr double at_most_longer = 2;
  return (options.max_length > 0 ? 1 : at_most_longer) * first_length(scene, options);
}

SolveMesh make_solve_mesh(const SoundScene& scene, const SolveOptions& options,
                          const Progress& progress, double min_angle) {
  require_few_surfaces(scene, options);
  std::optional<SolveMesh> best;
  double last = HUGE_VAL;  // angle tried
  for (const double angle : {min_angle, 10., 5., 0.}) {
    if (angle >= last) continue;
    last = angle;
    std::optional<SolveMesh> mesh = mesh_near(scene, options, angle, progress);
    if (mesh && (!best || mesh->elements.count() < best->elements.count())) best = std::move(mesh);
    if (progress.stopped() || (best && is_few_enough(*best, options))) break;
  }
  if (!best) refuse(scene, options);
  return *std::move(best);
}

SolveMesh make_solve_mesh(const SoundScene& scene, const Discontinuities& found, SolveMesh plain,
                          const SolveOptions& options, double mean_irradiance,
                          const Progress& progress) {
  SizeSearch search(scene, options, plain.elements.count());
  std::optional<SolveMesh> best;
  DiscontinuityMeshOptions mesh_options;
  mesh_options.min_angle = plain.min_angle;
  mesh_options.deviation = options.deviation;
  // Some more than would do, so that a mesh that ended early is known by its size.
  mesh_options.max_triangles = 4 * static_cast<std::size_t>(options.max_elements);
  for (bool again = true; again;) {
    mesh_options.max_length = search.length();
    mesh_options.irradiance_tolerance = search.tolerance() * mean_irradiance;
    std::optional<SolveMesh> mesh = try_mesh(scene, found, mesh_options, progress);
    const double count = mesh ? mesh->elements.count() : 2. * options.max_elements;
    const bool fits = mesh && !search.is_too_many(count);
    if (fits && (!best || search.tolerance() > best->tolerance ||
                 search.distance(count) < search.distance(best->elements.count()))) {
      best = std::move(mesh);
      best->tolerance = search.tolerance();
    }
    again = !progress.stopped() && search.improve(count);
  }
  if (best) return *std::move(best);
  plain.report.culled = found.curves.size();
  plain.tolerance = search.tolerance();
  return plain;
}

}  // namespace halfshade
