#include "io/study/study_methods.h"

#include "meshing/core/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace halfshade {
namespace {

using Words = std::vector<std::string>;

/// More than any case needs within the usual time: what stops it is its time.
constexpr int most_elements = 400000, most_unknowns = 8000000;
/// Memory of the dense matrix grows with the square.
constexpr double most_matrix_elements = 40000;

Words adaptive(double tolerance, const Words& more) {
  Words words = {"--tolerance",    fmt::format("{}", tolerance),
                 "--max-elements", fmt::format("{}", most_elements),
                 "--max-unknowns", fmt::format("{}", most_unknowns)};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words fields(double tolerance) { return adaptive(tolerance, {}); }

Words without_curves(double tolerance) { return adaptive(tolerance, {"--no-discontinuity"}); }

Words adaptive_linear(double tolerance) {
  return adaptive(tolerance, {"--no-discontinuity", "--order", "1"});
}

Words adaptive_constant(double tolerance) {
  return adaptive(tolerance, {"--no-discontinuity", "--order", "0"});
}

Words curves(double tolerance) { return adaptive(tolerance, {"--force", "discontinuities"}); }

Words curves_constant(double tolerance) {
  return adaptive(tolerance, {"--force", "discontinuities", "--order", "0"});
}

/// Errors of elements that do not know the curves fall a little faster than their number grows.
Words uniform(double tolerance) {
  const double elements = std::max(1., std::round(4 / tolerance));
  if (elements > most_elements) return {};
  return adaptive(tolerance, {"--no-discontinuity", "--order", "2", "--refine", "uniform",
                              "--elements", fmt::format("{:.0f}", elements)});
}

Words uniform_hp(double tolerance) {
  const double elements = std::max(1., std::round(2 / tolerance));
  if (elements > most_elements) return {};
  return adaptive(tolerance, {"--no-discontinuity", "--refine", "uniform", "--elements",
                              fmt::format("{:.0f}", elements)});
}

Words uniform_constant(double tolerance) {
  const double elements = std::max(1., std::round(1 / (tolerance * tolerance)));
  if (elements > most_elements) return {};
  return adaptive(tolerance, {"--no-discontinuity", "--order", "0", "--refine", "uniform",
                              "--elements", fmt::format("{:.0f}", elements)});
}

/// The error of constant elements falls as one over the square root of their number.
Words constant_elements(double tolerance, const Words& more) {
  const double elements = std::max(1., std::round(1 / (tolerance * tolerance)));
  if (elements > most_matrix_elements) return {};
  Words words = {"--method",
                 "matrix",
                 "--no-discontinuity",
                 "--elements",
                 fmt::format("{:.0f}", elements),
                 "--max-elements",
                 "200000"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words matrix(double tolerance) { return constant_elements(tolerance, {}); }

/// The time of the solver alone is that of the stage "radiosity".
Words solved_by(const char* solver, double tolerance) {
  return constant_elements(tolerance, {"--solver", solver});
}

Words interpolated(double tolerance) { return constant_elements(tolerance, {"--interpolate"}); }

/// A tenth of the elements as patches; the steps between elements are some times the error.
Words subdivided(double tolerance) {
  constexpr double fewer = 0.1, step = 5;
  return constant_elements(
      tolerance / std::sqrt(fewer),
      {"--interpolate", "--subdivide", "2", "--gradient", fmt::format("{}", step * tolerance)});
}

Words hemicube(double tolerance) {
  return constant_elements(tolerance, {"--factors", "hemicube", "--direct-light", "matrix"});
}

Words exact_factors(double tolerance) {
  return constant_elements(tolerance, {"--factors", "exact", "--direct-light", "matrix"});
}

}  // namespace

const std::vector<StudyMethod>& study_methods() {
  static const std::vector<StudyMethod> methods = {
      {"fields", "solve as it is: polynomials on elements that follow the curves where that pays",
       fields},
      {"fields-no-curves", "the same without curves: elements are halved where the error is",
       without_curves},
      {"uniform", "elements of order 2, all of one size, 4 / tolerance of them", uniform},
      {"matrix", "constant elements, 1 / tolerance squared of them, and a matrix of form factors",
       matrix, true},
      {"hemicube", "as matrix, all light by hemicubes of 64 pixels along an edge: how it began",
       hemicube, true},
      {"exact-factors", "as matrix, all light by factors to exactly visible parts of elements",
       exact_factors, true},
      {"adaptive-linear", "elements of order 1, halved where the error is, without curves",
       adaptive_linear},
      {"adaptive-constant", "constant elements, halved where the error is, without curves",
       adaptive_constant},
      {"interpolated", "as matrix, then linear between values at corners of elements", interpolated,
       true},
      {"subdivided", "a tenth of them as patches, split in four twice where the light is steep",
       subdivided, true},
      {"jacobi", "as matrix, solved by gathering: all elements from those of the sweep before",
       [](double tolerance) { return solved_by("jacobi", tolerance); }, true},
      {"gauss-seidel", "as matrix, solved by gathering with the newest values",
       [](double tolerance) { return solved_by("gauss-seidel", tolerance); }, true},
      {"southwell", "as matrix, solved by shooting: the element with most power left to send first",
       [](double tolerance) { return solved_by("southwell", tolerance); }, true},
      {"southwell-ambient", "the same, with an ambient term for what is left to send",
       [](double tolerance) { return solved_by("southwell-ambient", tolerance); }, true},
      {"curves", "as fields, along the curves whether that pays or not", curves},
      {"curves-constant", "constant elements along the curves, halved where the error is",
       curves_constant},
      {"uniform-hp", "elements of one size, 2 / tolerance of them, each of the order it takes",
       uniform_hp},
      {"uniform-constant", "constant elements of one size, 1 / tolerance squared of them",
       uniform_constant}};
  return methods;
}

const StudyMethod& study_method(std::string_view name) {
  Words names;
  for (const StudyMethod& method : study_methods()) {
    if (method.name == name) return method;
    names.emplace_back(method.name);
  }
  throw Error(ErrorCode::usage, "study",
              fmt::format("'{}' is none of the methods {}", name, fmt::join(names, ", ")));
}

std::string name_of(const StudyCase& one) {
  return fmt::format("{}_{}", one.method, one.tolerance);
}

}  // namespace halfshade
