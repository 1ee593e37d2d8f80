#pragma once

#include "io/study/study.h"

#include <stop_token>

namespace halfshade {

/// The words of the command that a case is.
std::vector<std::string> case_command(const StudyCase& one, const StudyOptions& options);

/// Runs a case and measures what it took and how right it is. Nothing if stopped. Its report,
/// values and result stay in the folder "cases".
std::optional<StudyRow> run_case(const StudyCase& one, const StudyOptions& options,
                                 const StudyReference& reference, const std::stop_token& stop);

/// The .vtu of a case; it may not be there.
std::filesystem::path result_of(const StudyCase& one, const StudyOptions& options);

/// Removes the .vtu of cases that another of the same method is finer than: they are large.
void keep_finest_results(const std::vector<StudyRow>& rows, const StudyOptions& options);

}  // namespace halfshade
