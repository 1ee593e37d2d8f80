#pragma once

#include "io/study/study_reference.h"

#include <functional>

namespace halfshade {

struct StudyOptions {
  std::filesystem::path folder;      ///< made if it is not there
  std::vector<std::string> solve;    ///< the program, "solve", the scene and what else is the
                                     ///< same in all cases
  std::string key;                   ///< says what is studied: a study goes on if it is the same
  std::vector<std::string> methods;  ///< names; empty: the first six
  std::vector<double> tolerances;    ///< > 0; empty: 0.1, 0.03, … 1e-4
  double time_limit = 60;            ///< seconds for each case, > 0
  StudyReferenceOptions reference;
};

struct Study {
  StudyReference reference;
  std::vector<StudyRow> rows;
  bool complete = true;  ///< false if stopped
};

/// The files of a study in its folder.
std::filesystem::path study_file(const StudyOptions& options, const std::string& name);

/// Cases in the order they are run, loose tolerances first, so that an early end has something of
/// all methods.
std::vector<StudyCase> study_cases(const StudyOptions& options);

/// Runs all cases that are not in the folder's study.csv yet, each as a process of its own, and
/// adds a row when one is done: stopped and started again it loses no case and repeats none. After
/// a case that takes too long, a method's finer ones are left out; a larger time limit tries again.
/// `tell` gets each row that is new. Nothing if stopped before there was anything. Throws
/// Error(unwritable); Error(usage) if the folder holds the study of something else.
std::optional<Study> run_study(const PreparedScene& prepared, const StudyOptions& options,
                               const Progress& progress,
                               const std::function<void(const StudyRow&)>& tell);

}  // namespace halfshade
