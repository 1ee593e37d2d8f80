#pragma once

#include "io/study/study_methods.h"

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace halfshade {

enum class CaseEnd {
  done,
  not_accurate,  ///< solve ended short of the tolerance, and said so
  time_limit,    ///< ended for it took too long
  failed         ///< refused or crashed; `note` says why
};

/// Of the irradiance at the points of a study, relative to the root of the mean square of all
/// irradiance there. NaN where it is not known.
struct StudyError {
  double l2 = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();
};

/// What a case took and gave. Sizes are 0 and errors NaN unless it came to an end.
struct StudyRow {
  StudyCase one;
  CaseEnd end = CaseEnd::done;
  double seconds = 0, cpu_seconds = 0;  ///< of the stages of solve
  double process_seconds = 0;           ///< of the whole run, with reading and writing
  std::size_t peak_memory_bytes = 0;    ///< of the whole run
  std::size_t elements = 0;             ///< of the result, and of reflected light's own mesh
  std::size_t unknowns = 0;             ///< coefficients of all these, for each channel
  double estimated = std::numeric_limits<double>::quiet_NaN();  ///< what the run said
  StudyError total, direct, reflected;
  std::string stages;  ///< "name wall/cpu; …", seconds
  std::string note;

  double effectivity() const { return estimated / total.l2; }
};

bool has_result(const StudyRow& row);

/// A text table: lines of cells between commas, the first line naming them, comments (#) before it.
struct TextTable {
  std::string comment;  ///< the first one, without #
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< as many cells as the header has
};

/// Throws Error(invalid_input) with file and line for rows of another length.
TextTable read_table(const std::filesystem::path& path);

/// Writes rows, sorted by method and tolerance, as a table; `key` stands in its first line, what
/// columns mean in those after it. Columns are those of StudyRow with "error", "max_error" for the
/// total, then the same of direct and reflected light, and effectivity. Cells are empty where
/// nothing is known.
void write_study(const std::vector<StudyRow>& rows, const std::string& key,
                 const std::filesystem::path& path);

/// Reads it again. Throws Error(usage) if the file has another key, Error(invalid_input) if it is
/// no such table.
std::vector<StudyRow> read_study(const std::string& key, const std::filesystem::path& path);

/// Throws Error(usage) unless the comment of a table at `path` is `key`.
void require_key(const TextTable& table, const std::string& key, const std::filesystem::path& path);

/// The number in a cell, NaN if that is empty.
double number_in(const std::string& cell, const std::filesystem::path& path);

}  // namespace halfshade
