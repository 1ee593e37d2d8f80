#include "io/study/study_page.h"

#include "io/study/html_text.h"
#include "io/study/study_gains.h"
#include "io/study/study_pictures.h"
#include "io/study/study_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace halfshade {
namespace {

using namespace detail;

constexpr const char* end_words[] = {"done", "short of the tolerance", "took too long", "failed"};

constexpr const char* style = R"(
body{font:15px/1.5 Arial,Helvetica,sans-serif;color:#222;max-width:1120px;margin:2em auto;padding:0 1em}
h1{font-size:1.7em;margin-bottom:.2em}h2{font-size:1.25em;margin-top:2em;border-bottom:1px solid #ddd}
table{border-collapse:collapse;font-size:13px;margin:.8em 0}
td,th{padding:.25em .55em;text-align:right;border-bottom:1px solid #e4e4e4;vertical-align:top}
th{background:#f5f5f3}td.text,th.text{text-align:left}.name{white-space:nowrap}.best{font-weight:bold}
code,pre{font:13px/1.45 Consolas,"DejaVu Sans Mono",monospace;background:#f5f5f3}
pre{padding:.7em;overflow-x:auto}svg,img{max-width:100%;height:auto}
figure{display:inline-block;width:46%;margin:.5em 1%;vertical-align:top}
figcaption{font-size:13px;color:#555}.scroll{overflow-x:auto}.quiet{color:#666}
)";

std::string methods_list(const Study& study) {
  std::string html = "<ul>\n";
  for (const std::string& name : methods_in(study))
    html += fmt::format("<li><code>{}</code>: {}</li>\n", name, escaped(study_method(name).what));
  return html + "</ul>\n";
}

std::string reach_table(const Study& study) {
  const std::vector<std::string> methods = methods_in(study);
  std::string html = "<table><tr><th>error at most</th>";
  for (const std::string& name : methods) html += fmt::format("<th>{}</th>", name);
  html += "</tr>\n";
  for (const double target : reached_errors(study)) {
    double best = 0;
    for (const std::string& name : methods)
      if (const double s = seconds_to_reach(study, name, target); s > 0 && (best == 0 || s < best))
        best = s;
    html += fmt::format("<tr><td>{:g}</td>", target);
    for (const std::string& name : methods) {
      const double s = seconds_to_reach(study, name, target);
      html += s > 0 ? fmt::format("<td{}>{:.3g} s</td>", s == best ? " class=\"best\"" : "", s)
                    : std::string("<td class=\"quiet\">not reached</td>");
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string number(double value, const char* format = "{:.2g}") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : std::string();
}

std::string case_table(const Study& study) {
  const bool reflects = study.reference.noise() > 0;
  std::string html =
      "<div class=\"scroll\"><table><tr><th class=\"text\">method</th><th>tolerance</th>"
      "<th>run time, s</th><th>CPU, s</th><th>memory, MB</th><th>elements</th><th>unknowns</th>"
      "<th>error</th><th>largest error</th>";
  if (reflects) html += "<th>direct</th><th>reflected</th>";
  html += "<th>estimated</th><th>estimated / true</th><th class=\"text\"></th></tr>\n";
  for (const StudyRow& row : study.rows) {
    const bool result = has_result(row);
    html += fmt::format(
        "<tr><td class=\"text name\">{}</td><td>{:g}</td><td>{:.3g}</td><td>{:.3g}</td>"
        "<td>{:.0f}</td>",
        row.one.method, row.one.tolerance, row.seconds, row.cpu_seconds,
        static_cast<double>(row.peak_memory_bytes) / 1e6);
    html += result ? fmt::format("<td>{}</td><td>{}</td>", row.elements, row.unknowns)
                   : std::string("<td></td><td></td>");
    html += fmt::format("<td>{}</td><td>{}</td>", number(row.total.l2), number(row.total.max));
    if (reflects)
      html +=
          fmt::format("<td>{}</td><td>{}</td>", number(row.direct.l2), number(row.reflected.l2));
    html += fmt::format("<td>{}</td><td>{}</td><td class=\"text name quiet\">{}</td></tr>\n",
                        number(row.estimated), number(row.effectivity()),
                        row.end == CaseEnd::done ? "" : end_words[static_cast<int>(row.end)]);
  }
  return html + "</table></div>\n";
}

std::string reference_text(const Study& study, const StudyOptions& options) {
  const StudyReference& reference = study.reference;
  std::string html = fmt::format(
      "<p>Errors are those at {} points, spread over all surfaces by area, the same for all cases. "
      "They are differences of irradiance in the L2 norm, channels summed, relative to the "
      "irradiance's own norm ({:.4g} W/m² a point); largest errors are relative to the same. ",
      reference.direct.size(), reference.scale());
  html +=
      "Direct light there is compared with exact values: closed forms on the exactly visible "
      "parts of the emitters. ";
  if (options.reference.direct_only)
    html += "Light that is reflected is left out.</p>\n";
  else if (reference.noise() > 0)
    html += fmt::format(
        "Reflected light is compared with random walks that share nothing with the methods but the "
        "scene and its rays. Their standard error is {:.2g} of the irradiance in the L2 norm. What "
        "it adds to the mean square is known and taken off, so that errors down to {:.2g} can be "
        "told (the shaded bands of the charts); what is below is given as that. Largest errors "
        "have the noise in them.</p>\n",
        reference.noise(), reference.resolution());
  else
    html +=
        "No reflected light arrives at any of them, by random walks, so that the values are "
        "exact.</p>\n";
  html +=
      "<p>An L2 error from so many points is itself off by some per cent; single elements that "
      "are far off may lie between them.</p>\n";
  return html;
}

std::string commands(const Study& study, const StudyOptions& options, const StudyPageInfo& info) {
  std::string html =
      fmt::format("<h2>To repeat it</h2>\n<pre>{}</pre>\n<p>Each case by itself:</p>\n<pre>",
                  escaped(info.command));
  for (const StudyRow& row : study.rows) {
    std::vector<std::string> words = case_command(row.one, options);
    words.front() = "halfshade";
    html += escaped(fmt::format("{}\n", fmt::join(words, " ")));
  }
  return html + "</pre>\n";
}

}  // namespace

std::string study_page(const Study& study, const StudyOptions& options, const StudyPageInfo& info) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>Error against run time: {0}"
      "</title>\n<style>{1}</style></head><body>\n<h1>Error against run time: {0}</h1>\n"
      "<p class=\"quiet\">halfshade {2}; {3}</p>\n",
      escaped(info.scene), style, escaped(info.version), escaped(machine_line()));
  if (!study.complete) html += "<p><b>The study was interrupted: cases are missing.</b></p>\n";
  const std::vector<StudyChart> charts = study_charts(study, info.scene);
  html += chart_svg(charts.front().chart);
  html +=
      "<h2>Time for an error</h2>\n<p>Of each method's fastest case that is at most so far "
      "off. Run times are those of the stages of <code>solve</code>, from polygons in memory "
      "to light on elements.</p>\n";
  html += reach_table(study) + where_the_default_loses(study) + what_the_default_gains(study);
  html += "<h2>Methods</h2>\n" + methods_list(study);
  html += "<h2>What is right, and how sure that is</h2>\n" + reference_text(study, options);
  html += "<h2>More charts</h2>\n";
  for (std::size_t k = 1; k < charts.size(); ++k) html += chart_svg(charts[k].chart);
  html += fmt::format(
      "<h2>All cases</h2>\n{}<p class=\"quiet\">Memory is the peak of the whole process, libraries "
      "included. Stage by stage: <code>study.csv</code>. A case may take {:g} s; when one took "
      "longer, the finer ones of its method were left out. Unknowns are coefficients for each "
      "channel of direct light, or constant elements.</p>\n",
      case_table(study), options.time_limit);
  html += study_pictures(study, options) + commands(study, options, info);
  return html + "</body></html>\n";
}

}  // namespace halfshade
