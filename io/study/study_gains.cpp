#include "io/study/study_gains.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace halfshade {
namespace {

constexpr double targets[] = {0.1, 0.03, 0.01, 0.003, 0.001, 3e-4, 1e-4, 1e-5, 1e-6};
/// Times that differ by less may as well be the same: other programs run, too.
constexpr double like_times = 1.2;
/// Looser errors take no time with any method.
constexpr double largest_compared = 0.01;
/// Of the time, from which on what methods have in common explains that they are alike.
constexpr double telling_share = 0.5;

std::string usual_method() { return std::string(study_methods().front().name); }

bool compares_with_the_default(const Study& study) {
  const std::vector<std::string> methods = methods_in(study);
  return methods.size() >= 2 && methods.front() == usual_method();
}

/// The fastest case of all methods of a kind but the default; null if none is there.
const StudyRow* fastest_other(const Study& study, bool classic, double error) {
  const StudyRow* fastest = nullptr;
  for (const std::string& name : methods_in(study)) {
    if (name == usual_method() || study_method(name).classic != classic) continue;
    const StudyRow* row = fastest_case(study, name, error);
    if (row && (!fastest || row->seconds < fastest->seconds)) fastest = row;
  }
  return fastest;
}

/// The most exact case of all methods of a kind but the default; null if there is none.
const StudyRow* nearest_other(const Study& study, bool classic) {
  const StudyRow* nearest = nullptr;
  for (const StudyRow& row : study.rows)
    if (row.one.method != usual_method() && study_method(row.one.method).classic == classic &&
        has_result(row) && (!nearest || row.total.l2 < nearest->total.l2))
      nearest = &row;
  return nearest;
}

/// Of a row's stages, "name wall/cpu; …", the seconds of those that find reflected light.
double seconds_of_reflected_light(const StudyRow& row) {
  constexpr std::string_view name = "reflected light ";
  double sum = 0;
  const std::string_view stages = row.stages;
  for (std::size_t k = stages.find(name); k != std::string_view::npos; k = stages.find(name, k)) {
    k += name.size();
    double seconds = 0;
    std::from_chars(stages.data() + k, stages.data() + stages.size(), seconds);
    sum += seconds;
  }
  return sum;
}

std::string times(double ratio) {
  return ratio < 10 ? fmt::format("{:.2g}", ratio) : fmt::format("{:.0f}", ratio);
}

/// Why methods that differ in direct light alone are alike.
std::string in_common(const StudyRow& own, const StudyRow& other) {
  const double same = seconds_of_reflected_light(own), its = seconds_of_reflected_light(other);
  if (!(same > telling_share * own.seconds && its > 0)) return {};
  return fmt::format(
      " ({:.0f} % is reflected light, which both find in the same way; without it they take "
      "{:.2g} s and {:.2g} s)",
      100 * same / own.seconds, own.seconds - same, other.seconds - its);
}

/// The case of the same method that took too long; null if there is none.
const StudyRow* cut_short(const Study& study, const StudyRow& row) {
  for (const StudyRow& other : study.rows)
    if (other.one.method == row.one.method && other.end == CaseEnd::time_limit) return &other;
  return nullptr;
}

/// Where none of a kind is exact enough: what the most exact one takes.
std::string falls_short(const Study& study, const StudyRow& own, const StudyRow& nearest) {
  const StudyRow* more = cut_short(study, nearest);
  return fmt::format(
      "<code>{}</code> is off by {:.2g} after {:.2g} s{}", nearest.one.method, nearest.total.l2,
      nearest.seconds,
      more ? fmt::format(", and at the next tolerance takes more than {:.0f} s, {} times as long",
                         more->process_seconds, times(more->process_seconds / own.seconds))
           : fmt::format(", {} times as long", times(nearest.seconds / own.seconds)));
}

std::string against(const Study& study, const StudyRow& own, bool classic, double error) {
  const char* kind = classic ? "classic" : "other";
  if (const StudyRow* fastest = fastest_other(study, classic, error))
    return fmt::format("; <code>{}</code>, the fastest {} one, {} times as long{}",
                       fastest->one.method, kind, times(fastest->seconds / own.seconds),
                       in_common(own, *fastest));
  if (const StudyRow* nearest = nearest_other(study, classic))
    return fmt::format("; no {} one gets there: {}", kind, falls_short(study, own, *nearest));
  return {};
}

std::string gain_at(const Study& study, double error) {
  const StudyRow* own = fastest_case(study, usual_method(), error);
  if (!own) return {};
  const std::string text = against(study, *own, false, error) + against(study, *own, true, error);
  if (text.empty()) return {};
  return fmt::format("<li>At {:g}, <code>{}</code> takes {:.3g} s{}.</li>\n", error, usual_method(),
                     own->seconds, text);
}

std::string loss_at(const Study& study, const std::string& method, double error) {
  const StudyRow *own = fastest_case(study, usual_method(), error),
                 *other = fastest_case(study, method, error);
  if (!other || (own && like_times * other->seconds >= own->seconds)) return {};
  return own ? fmt::format(
                   "<li>At {:g}, <code>{}</code> is {:.2g} times as fast as <code>{}</code>.</li>"
                   "\n",
                   error, method, own->seconds / other->seconds, usual_method())
             : fmt::format("<li><code>{}</code> reaches {:g}, <code>{}</code> does not.</li>\n",
                           method, error, usual_method());
}

}  // namespace

std::vector<std::string> methods_in(const Study& study) {
  std::vector<std::string> names;
  for (const StudyMethod& method : study_methods())
    if (std::any_of(study.rows.begin(), study.rows.end(),
                    [&](const StudyRow& row) { return row.one.method == method.name; }))
      names.emplace_back(method.name);
  return names;
}

const StudyRow* fastest_case(const Study& study, const std::string& method, double error) {
  const StudyRow* fastest = nullptr;
  for (const StudyRow& row : study.rows)
    if (row.one.method == method && has_result(row) && row.total.l2 <= error &&
        (!fastest || row.seconds < fastest->seconds))
      fastest = &row;
  return fastest;
}

std::vector<double> reached_errors(const Study& study) {
  const std::vector<std::string> methods = methods_in(study);
  std::vector<double> result;
  for (const double target : targets)
    if (target >= study.reference.resolution() &&
        std::any_of(methods.begin(), methods.end(), [&](const std::string& name) {
          return fastest_case(study, name, target) != nullptr;
        }))
      result.push_back(target);
  return result;
}

std::string where_the_default_loses(const Study& study) {
  if (!compares_with_the_default(study)) return {};
  std::string html;
  for (const double error : reached_errors(study))
    for (const std::string& method : methods_in(study))
      if (method != usual_method()) html += loss_at(study, method, error);
  if (html.empty())
    return fmt::format(
        "<p>The default, <code>{}</code>, is the fastest at each of these, or as good as "
        "that.</p>\n",
        usual_method());
  return "<p>The default is not the fastest everywhere:</p>\n<ul>\n" + html + "</ul>\n";
}

std::string what_the_default_gains(const Study& study) {
  if (!compares_with_the_default(study)) return {};
  std::string html;
  for (const double error : reached_errors(study))
    if (error <= largest_compared) html += gain_at(study, error);
  if (html.empty()) return {};
  return "<p>What the default gains (classic are methods with constant elements and a matrix of "
         "form factors):</p>\n<ul>\n" +
         html + "</ul>\n";
}

}  // namespace halfshade
