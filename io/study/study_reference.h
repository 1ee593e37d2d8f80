#pragma once

#include "io/read/read_points.h"
#include "io/study/study_table.h"
#include "solver/pipeline/prepared_scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace halfshade {

struct StudyReferenceOptions {
  int points = 1000;         ///< spread over all surfaces by area, ≥ 1
  int samples = 16384;       ///< random walks from each, see ReferenceOptions
  bool direct_only = false;  ///< of cases, too: no light is reflected
};

/// What is right at the points of a study, and how sure that is.
struct StudyReference {
  PointTable points;
  std::vector<Rgb> direct;           ///< exact, W/m²
  std::vector<Rgb> reflected;        ///< by random walks, W/m²
  std::vector<Rgb> reflected_error;  ///< standard errors

  /// Root of the mean square of all irradiance, channels summed: what errors are relative to.
  double scale() const;
  /// The standard errors in the L2 norm, relative to it; 0 if nothing is reflected.
  double noise() const;
  /// Errors of the total below this cannot be told from none, see errors_at.
  double resolution() const;
};

/// Points: one in each of as many equal parts of the area, at random. Nothing if stopped.
std::optional<StudyReference> find_reference(const PreparedScene& prepared,
                                             const StudyReferenceOptions& options,
                                             const Progress& progress);

/// As a table with the columns of the points, D_r, … (direct), G_r, … (reflected), G_r_error, ….
void write_reference(const StudyReference& reference, const std::string& key,
                     const std::filesystem::path& path);
StudyReference read_reference(const std::string& key, const std::filesystem::path& path);

/// The points alone, as `solve --points` reads them.
void write_places(const StudyReference& reference, const std::filesystem::path& path);

/// The light that a solution gives at the points.
struct StudyValues {
  std::vector<Rgb> irradiance, direct;
};

/// Reads what `solve --values` has written. Throws Error(invalid_input).
StudyValues read_values(const std::filesystem::path& path);

/// Fills the errors of a row. The mean square of the noise is known and independent of the
/// solution's error, so it is taken off: what is left is without bias, but below resolution() it is
/// noise, and then the resolution is given as the error. Largest errors are as found, noise
/// included. Precondition: as many values as points.
void fill_errors(const StudyReference& reference, const StudyValues& values, StudyRow& row);

}  // namespace halfshade
