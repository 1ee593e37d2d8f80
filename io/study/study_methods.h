#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace halfshade {

/// A way to solve a scene that a study measures.
struct StudyMethod {
  std::string_view name;
  std::string_view what;  ///< a phrase for those who read the study
  /// Options of `solve` for a tolerance; empty if the method cannot do it.
  std::vector<std::string> (*options)(double tolerance);
  bool classic = false;  ///< constant elements and a matrix of form factors
};

/// All there are, the default one first.
const std::vector<StudyMethod>& study_methods();

/// Throws Error(usage) if there is none of this name.
const StudyMethod& study_method(std::string_view name);

/// One run of a study.
struct StudyCase {
  std::string method;
  double tolerance = 0.01;

  bool operator==(const StudyCase&) const = default;
};

/// A case as files and progress name it: "fields_0.01".
std::string name_of(const StudyCase& one);

}  // namespace halfshade
