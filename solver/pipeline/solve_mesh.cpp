#include "solver/pipeline/solve_mesh.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace halfshade {
namespace {

/// The elements asked for are not exceeded unless the geometry takes more, and numbers less than
/// this share below them count as what was asked for; in the middle of that is aimed at.
constexpr double near_enough = 0.1;
constexpr double aim = 1 - near_enough / 2;

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

/// The inverse square of the length, which the number of elements is nearly linear in, between one
/// that makes too many and one that does not.
class DensitySearch {
 public:
  /// None below `least`.
  DensitySearch(double first, double wanted, double least = 0)
      : density_(first), wanted_(wanted), least_(least) {}

  double length() const { return 1 / std::sqrt(density_); }

  /// Changes the density after it gave `count` elements; false if there is no need or no way.
  bool improve(double count) {
    if (count <= wanted_ && count >= (1 - near_enough) * wanted_) return false;
    if (count > wanted_ && density_ <= least_) return false;
    Tried& side = count > wanted_ ? above_ : below_;
    const bool is_same = side.count == count, is_alone = !(below_.count > 0);
    // What the geometry alone takes is left, if it was not a step too small to matter.
    if (is_same && is_alone && side.density > at_most / 2 * density_) return false;
    side = {density_, count};
    density_ = std::max(is_same && is_alone ? density_ / at_most : next(), least_);
    return true;
  }

 private:
  static constexpr double at_most = 8;  ///< that the density changes at once

  struct Tried {
    double density = 0, count = 0;  ///< 0: not yet
  };

  double next() const {
    constexpr double margin = 0.1;
    const double target = aim * wanted_;
    if (!(above_.count > 0))
      return below_.density * std::clamp(target / below_.count, 1 + margin, at_most);
    if (!(below_.count > 0))
      return above_.density * std::clamp(target / above_.count, 1 / at_most, 1 - margin);
    const double share = (target - below_.count) / (above_.count - below_.count);
    return below_.density +
           std::clamp(share, margin, 1 - margin) * (above_.density - below_.density);
  }

  double density_, wanted_, least_;
  Tried below_, above_;
};

/// How the length and the tolerance come to suit the number of elements asked for: curves make some
/// of their own, whatever the length.
class SizeSearch {
 public:
  /// `plain` is how many elements it takes without curves.
  SizeSearch(const SoundScene& scene, const SolveOptions& options, int plain)
      : is_fixed_(options.max_length > 0),
        most_(is_fixed_ ? options.max_elements
                        : std::min(options.max_elements, std::max(options.elements, plain))),
        longest_(longest_edge(scene, options)),
        density_(along(first_length(scene, options))),
        tolerance_(options.tolerance) {}

  double length() const { return density_.length(); }
  double tolerance() const { return tolerance_; }
  bool is_too_many(double count) const { return count > most_; }

  /// Changes length or tolerance after they gave `count` elements; false if there is no need or no
  /// way.
  bool improve(double count) {
    const bool is_longest = is_fixed_ || length() >= (1 - near_enough) * longest_;
    has_fit_ = has_fit_ || !is_too_many(count);
    if (!has_fit_ && (is_longest || changes_ >= most_changes)) {
      tolerance_ = std::max(smallest_raised, raise * tolerance_);
      density_ = along(length());
      return raises_++ < most_raises;
    }
    return !is_fixed_ && changes_++ < most_changes && density_.improve(count);
  }

 private:
  static constexpr double raise = 4, smallest_raised = 0.01;
  static constexpr int most_raises = 8, most_changes = 8;

  DensitySearch along(double length) const {
    return {std::pow(length, -2), most_, std::pow(longest_, -2)};
  }

  bool is_fixed_;
  double most_, longest_;
  DensitySearch density_;
  double tolerance_;
  int raises_ = 0, changes_ = 0;
  bool has_fit_ = false;  ///< some numbers were not too many
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

/// Of two numbers of elements: as many as possible that are no more than asked for, else as few.
bool is_better(int count, int other, int asked) {
  if (count > asked || other > asked) return count < other;
  return count > other;
}

/// With the length that is asked for, or with the one that takes the most elements that are not
/// more than asked for; where all take more, the fewest.
std::optional<SolveMesh> mesh_within(const SoundScene& scene, const SolveOptions& options,
                                     double min_angle, const Progress& progress) {
  constexpr int attempts = 10;
  PlanarMeshOptions mesh_options;
  mesh_options.min_angle = min_angle;
  mesh_options.max_triangles = static_cast<std::size_t>(options.max_elements);
  mesh_options.max_length = first_length(scene, options);
  if (options.max_length > 0) return try_plainly(scene, mesh_options, progress);
  DensitySearch search(std::pow(mesh_options.max_length, -2), options.elements);
  std::optional<SolveMesh> best;
  for (int k = 0; k < attempts && (k == 0 || !progress.stopped()); ++k) {
    mesh_options.max_length = search.length();
    std::optional<SolveMesh> mesh = try_plainly(scene, mesh_options, progress);
    const int count = mesh ? mesh->elements.count() : 2 * options.max_elements;
    if (mesh && (!best || is_better(count, best->elements.count(), options.elements)))
      best = std::move(mesh);
    if (!search.improve(count)) break;
  }
  return best;
}

/// What the geometry takes at least.
std::optional<SolveMesh> mesh_fewest(const SoundScene& scene, const SolveOptions& options,
                                     const Progress& progress) {
  PlanarMeshOptions mesh_options;
  mesh_options.min_angle = 0;
  mesh_options.max_triangles = static_cast<std::size_t>(options.max_elements);
  return try_plainly(scene, mesh_options, progress);
}

bool is_few_enough(const SolveMesh& mesh, const SolveOptions& options) {
  return options.max_length > 0 || mesh.elements.count() <= options.elements;
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
  if (options.max_length == 0 && least_elements(scene) > at(options.elements)) {
    best = mesh_fewest(scene, options, progress);
    if (!best) refuse(scene, options);
    return *std::move(best);
  }
  double last = HUGE_VAL;  // angle tried
  for (const double angle : {min_angle, 10., 5., 0.}) {
    if (angle >= last) continue;
    last = angle;
    std::optional<SolveMesh> mesh = mesh_within(scene, options, angle, progress);
    if (mesh && (!best || mesh->elements.count() < best->elements.count())) best = std::move(mesh);
    if (progress.stopped() || (best && is_few_enough(*best, options))) break;
  }
  if (!best && options.max_length == 0) best = mesh_fewest(scene, options, progress);
  if (!best) refuse(scene, options);
  return *std::move(best);
}

std::string no_elements_for_curves(int plain_elements, const SolveOptions& options) {
  const bool none_left = options.max_length == 0 && plain_elements > options.elements;
  return none_left && !options.force.discontinuities
             ? "the geometry alone takes more elements than asked for"
             : "";
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
    if (fits && (!best || count > best->elements.count())) {
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
