#include "io/study/study_pictures.h"

#include "io/picture/value_picture.h"
#include "io/read/read_text.h"
#include "io/study/html_text.h"
#include "io/study/study_gains.h"
#include "io/study/study_run.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

constexpr int picture_pixels = 420, picture_samples = 4;
constexpr const char* compared = "irradiance";

/// The finest case of each method whose result is still there.
std::vector<const StudyRow*> finest_cases(const Study& study, const StudyOptions& options) {
  std::vector<const StudyRow*> finest;
  for (const std::string& name : methods_in(study)) {
    const StudyRow* last = nullptr;
    for (const StudyRow& row : study.rows)
      if (row.one.method == name && has_result(row) && fs::exists(result_of(row.one, options)))
        last = &row;
    if (last) finest.push_back(last);
  }
  return finest;
}

std::string figure(const Picture& picture, const fs::path& file, const std::string& name,
                   const std::string& caption) {
  write_png(picture, file);
  return fmt::format(
      "<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption>"
      "</figure>\n",
      name, detail::base64(reading::read_bytes(file)), caption);
}

/// One result minus the most exact one. Rays that end at one surface or at another right behind it
/// make that meaningless; then a sentence says so.
std::string difference_figure(const ResultFile& file, const StudyRow& row, const ValueMesh& right,
                              const std::string& best, const Camera& camera,
                              const PictureOptions& look, const StudyOptions& options) {
  const std::string& name = row.one.method;
  try {
    const ValuePicture off = draw_difference(quantity_of(file, compared), right, camera, look);
    return figure(off.picture, study_file(options, name + "_difference.png"), name + ", difference",
                  fmt::format("<code>{}</code> minus <code>{}</code>: {:.2g} of the light that is "
                              "seen, in the root of the mean square",
                              name, best, off.difference.relative));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::invalid_input) throw;
    return fmt::format(
        "<figure><figcaption><code>{}</code> and <code>{}</code> do not show the same places, so "
        "that a difference has no meaning.</figcaption></figure>\n",
        name, best);
  }
}

}  // namespace

std::string study_pictures(const Study& study, const StudyOptions& options) {
  const std::vector<const StudyRow*> cases = finest_cases(study, options);
  if (cases.empty()) return {};
  const StudyRow* best = *std::min_element(
      cases.begin(), cases.end(),
      [](const StudyRow* a, const StudyRow* b) { return a->total.l2 < b->total.l2; });
  const ResultFile best_file = read_result(result_of(best->one, options));
  const ValueMesh right = quantity_of(best_file, compared);
  PictureOptions look;
  look.width = look.height = picture_pixels;
  look.samples = picture_samples;
  std::string html = fmt::format(
      "<h2>Pictures</h2>\n<p>Each method's finest result, all as bright as the first, and its "
      "irradiance minus that of the most exact of them, <code>{}</code> at {:g}: red is too much, "
      "blue too little, each in colours of its own.</p>\n",
      best->one.method, best->one.tolerance);
  for (const StudyRow* row : cases) {
    const std::string& name = row->one.method;
    const ResultFile file = read_result(result_of(row->one, options));
    const ShadedMesh mesh = shaded(file);
    const Camera camera = default_camera(mesh);
    const Picture picture = draw(mesh, camera, look);
    look.exposure = picture.exposure;
    html += figure(picture, study_file(options, name + ".png"), name,
                   fmt::format("<code>{}</code> at tolerance {:g}: error {:.2g}, {:.3g} s", name,
                               row->one.tolerance, row->total.l2, row->seconds));
    if (row != best)
      html += difference_figure(file, *row, right, best->one.method, camera, look, options);
  }
  return html;
}

}  // namespace halfshade
