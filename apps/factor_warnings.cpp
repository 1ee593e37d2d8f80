#include "apps/factor_warnings.h"

#include "meshing/core/plane_frame.h"
#include "meshing/core/tolerance.h"
#include "meshing/repair/repair_sentence.h"
#include "solver/pipeline/first_few.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

namespace halfshade {
namespace {

/// Backs that swallow more than this deserve a word.
constexpr double noticeable_backs = 1e-3;
/// Of a face's area or size: form factors are right to as much if nothing else is asked for.
constexpr double noticeable = 1e-4;
/// Of coordinates: points that are nearer count as one.
constexpr double rounding = 1e-9;

double area_of(const Scene& scene, int face) {
  return area_vector(face_corners(scene, face)).norm();
}

double size_of(const Scene& scene, int face) { return scale_of(face_corners(scene, face)).size; }

/// How far two faces that were put into one plane lie apart; 0 if it is rounding.
double apart(const Scene& scene, const Repair& overlap) {
  const PlaneFrame plane = fit_plane(face_corners(scene, overlap.faces.back()));
  double height = 0, largest = 0;
  for (const Vec3& corner : face_corners(scene, overlap.faces.front())) {
    height = std::max(height, std::abs(plane.height(corner)));
    largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  }
  return height > rounding * largest ? height : 0;
}

/// Whether a face lost a part of its area to one that lies on it.
bool is_cut(const Scene& scene, const Repair& repair) {
  return repair.kind == Repair::Kind::overlap_removed &&
         repair.size > noticeable * area_of(scene, repair.faces.back());
}

/// Whether what was put right may have changed form factors.
bool matters(const Scene& scene, const Repair& repair) {
  const int face = repair.faces.front();
  switch (repair.kind) {
    case Repair::Kind::coplanar_merged:
    case Repair::Kind::narrow_gap:  // whose factors are known
      return false;
    case Repair::Kind::degenerate_dropped:
      return area_of(scene, face) > noticeable * std::pow(size_of(scene, face), 2);
    case Repair::Kind::duplicate_dropped:
    case Repair::Kind::crossed_split:
    case Repair::Kind::gap_shut:
      return true;
    case Repair::Kind::non_planar_triangulated:
      return repair.size > noticeable * size_of(scene, face);
    case Repair::Kind::overlap_removed: {
      // A lamp set into a ceiling, or a rug on a floor, is what its maker wanted.
      const double smaller = std::min(area_of(scene, face), area_of(scene, repair.faces.back()));
      return is_cut(scene, repair) &&
             (repair.size < (1 - noticeable) * smaller || apart(scene, repair) > 0);
    }
  }
  return false;
}

/// The first repair in words, and how many more there are; empty if there is none.
std::string sentence_of(const Scene& scene, const FactorMatrix& matrix,
                        const std::vector<const Repair*>& found) {
  if (found.empty()) return {};
  std::string text = sentence(*found.front(), matrix.scene);
  if (is_cut(scene, *found.front()))
    if (const double distance = apart(scene, *found.front()); distance > 0)
      text += fmt::format(", for they are no more than {:.2g} apart", distance);
  if (found.size() > 1)
    text += fmt::format("; and {} more like it (--verbose lists them)", found.size() - 1);
  return text;
}

/// Empty if there are no names.
std::string no_rows(const std::vector<std::string>& names, std::string_view why_one,
                    std::string_view why_many) {
  if (names.empty()) return {};
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back(fmt::format("'{}'", name));
  const bool are_many = names.size() > 1;
  return fmt::format("{} {}: {}", first_few(quoted), are_many ? "have no rows" : "has no row",
                     are_many ? why_many : why_one);
}

}  // namespace

std::vector<Warning> warnings_of(const Scene& scene, const FactorMatrix& matrix) {
  std::vector<Warning> warnings;
  std::vector<const Repair*> changes;
  for (const Repair& repair : matrix.scene.repairs)
    if (matters(scene, repair)) changes.push_back(&repair);
  if (!changes.empty())
    warnings.push_back({Warning::Kind::faces_changed,
                        "making the scene sound may have changed its form factors: " +
                            sentence_of(scene, matrix, changes)});
  const FactorReport& report = matrix.report;
  if (report.backs_max >= noticeable_backs)
    warnings.push_back(
        {Warning::Kind::light_escapes,
         fmt::format("backs of one-sided faces swallow {:.2g} % of what leaves '{}'; it is counted "
                     "as space",
                     100 * report.backs_max, matrix.names[at(report.backs_row)])});
  return warnings;
}

std::string note_of(const Scene& scene, const FactorMatrix& matrix) {
  std::vector<const Repair*> cuts;
  for (const Repair& repair : matrix.scene.repairs)
    if (is_cut(scene, repair) && !matters(scene, repair)) cuts.push_back(&repair);
  return sentence_of(scene, matrix, cuts);
}

std::string rows_without_faces(const SceneFile& file, FactorUnit unit) {
  if (unit != FactorUnit::group) return {};
  return no_rows(file.empty_groups, "the file gives it no face", "the file gives them no faces");
}

std::string missing_rows(const Scene& scene, const FactorMatrix& matrix, FactorUnit unit) {
  if (unit == FactorUnit::face) return {};
  const bool is_by_group = unit == FactorUnit::group;
  std::set<int> used;
  for (const Face& face : scene.faces) used.insert(is_by_group ? face.group : face.material);
  const std::set<std::string> names(matrix.names.begin(), matrix.names.end());
  std::vector<std::string> missing;
  for (const int id : used)
    if (!names.contains(row_name(scene, unit, {id, false})) &&
        !names.contains(row_name(scene, unit, {id, true})))
      missing.push_back(row_name(scene, unit, {id, false}));
  return no_rows(missing, "none of its faces was left when the scene was made sound",
                 "none of their faces was left when the scene was made sound");
}

}  // namespace halfshade
