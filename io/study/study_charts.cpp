#include "io/study/study_gains.h"
#include "io/study/study_page.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

using Value = double (*)(const StudyRow&);

double error(const StudyRow& row) { return row.total.l2; }
double direct_error(const StudyRow& row) { return row.direct.l2; }
double reflected_error(const StudyRow& row) { return row.reflected.l2; }
double seconds(const StudyRow& row) { return row.seconds; }
double cpu_seconds(const StudyRow& row) { return row.cpu_seconds; }
double unknowns(const StudyRow& row) { return static_cast<double>(row.unknowns); }
double estimated(const StudyRow& row) { return row.estimated; }

std::vector<ChartSeries> series_of(const Study& study, Value x, Value y) {
  std::vector<ChartSeries> result;
  for (const StudyMethod& method : study_methods()) {
    ChartSeries series{std::string(method.name), {}};
    for (const StudyRow& row : study.rows)
      if (row.one.method == method.name && has_result(row))
        series.points.emplace_back(x(row), y(row));
    if (!series.points.empty()) result.push_back(std::move(series));
  }
  return result;
}

}  // namespace

std::vector<StudyChart> study_charts(const Study& study, const std::string& scene) {
  const double unknown = study.reference.resolution();
  const char* const error_label = "L2 error, relative to the irradiance";
  std::vector<StudyChart> charts = {{"error_time",
                                     {"error against run time", "run time, s", error_label,
                                      series_of(study, seconds, error), false, unknown}},
                                    {"error_cpu",
                                     {"error against CPU time", "CPU time, s", error_label,
                                      series_of(study, cpu_seconds, error), false, unknown}},
                                    {"error_unknowns",
                                     {"error against unknowns", "unknowns a channel", error_label,
                                      series_of(study, unknowns, error), false, unknown}}};
  if (study.reference.noise() > 0) {
    charts.push_back({"direct_error_time",
                      {"error of direct light against run time", "run time, s", error_label,
                       series_of(study, seconds, direct_error)}});
    charts.push_back({"reflected_error_time",
                      {"error of reflected light against run time", "run time, s", error_label,
                       series_of(study, seconds, reflected_error), false, unknown}});
  }
  charts.push_back({"estimated_true",
                    {"estimated against true error", "true L2 error", "estimated L2 error",
                     series_of(study, error, estimated), true}});
  for (StudyChart& chart : charts) chart.chart.title = scene + ": " + chart.chart.title;
  return charts;
}

double seconds_to_reach(const Study& study, const std::string& method, double error) {
  const StudyRow* fastest = fastest_case(study, method, error);
  return fastest ? fastest->seconds : 0;
}

}  // namespace halfshade
