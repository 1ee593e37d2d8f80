#include "solver/factors/saved_factors.h"

#include "meshing/core/error.h"
#include "solver/factors/finished_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace halfshade {
namespace {

/// Areas are written with all their digits; what is more than this apart, relative, are two.
constexpr double same_area = 1e-9;
/// How far the two halves of A F may be apart, of the smaller of two areas.
constexpr double reciprocal_within = 1e-9;
/// How far shares of a row may be off what they add up to: some digits of a text may be rounded.
constexpr double share_within = 1e-9;
/// Relative to a face and its distance from the origin, as points that are one for the repair.
constexpr double same_place = 1e-9;
/// Of normals; what is turned by less extends as far as before.
constexpr double same_normal = 1e-6;

[[noreturn]] void refuse(const FactorMatrix& saved, const std::string& sentence) {
  throw Error(ErrorCode::invalid_input, saved.source, sentence);
}

/// Which row of the sums each row of the faces is part of; `sums` gets names and areas.
std::vector<int> sum_rows(const Scene& scene, const FactorScene& faces, FactorUnit unit,
                          FactorScene& sums) {
  std::map<FactorRow, int> rows;
  std::vector<FactorRow> keys;
  for (const FactorRow& face : faces.keys) {
    const Face& input = scene.faces[at(face.id)];
    const int id = unit == FactorUnit::face    ? face.id
                   : unit == FactorUnit::group ? input.group
                                               : input.material;
    keys.push_back({id, face.is_back});
    rows.emplace(keys.back(), 0);
  }
  for (auto& [key, row] : rows) {
    row = sums.rows();
    sums.keys.push_back(key);
    sums.names.push_back(row_name(scene, unit, key));
    sums.areas.push_back(0);
  }
  std::vector<int> result;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    result.push_back(rows[keys[k]]);
    sums.areas[at(result.back())] += faces.areas[k];
  }
  return result;
}

RowExchange summed_exchange(const FactorMatrix& saved, const std::vector<int>& row, int rows) {
  const RowMajorMatrix mutual = mutual_areas(saved);
  const Eigen::ArrayXd error = saved.area * saved.error;
  RowExchange sums(rows);
  for (Eigen::Index a = 0; a < mutual.rows(); ++a) {
    const int i = row[static_cast<std::size_t>(a)];
    for (Eigen::Index b = 0; b < mutual.cols(); ++b) {
      const int j = row[static_cast<std::size_t>(b)];
      sums.mutual(i, j) += mutual(a, b);
      sums.mutual_error(i, j) += std::min(error[a], error[b]);
    }
    sums.space[i] += saved.area[a] * saved.space[a];
    sums.space_error[i] += error[a];
  }
  // Sums of the same numbers in another order.
  sums.mutual = (0.5 * (sums.mutual + sums.mutual.transpose())).eval();
  return sums;
}

/// Whether a row adds up to a sum, with what was left out of it. Where the file does not tell that,
/// it is what is missing, as far as the error of each zero allows.
bool adds_up_to(double sum, const FactorMatrix& saved, Eigen::Index row) {
  const double found = saved.factors.row(row).sum() + saved.space[row];
  const auto zeros = static_cast<double>((saved.factors.row(row).array() == 0).count());
  const double left_out = saved.left_out.size() > 0
                              ? saved.left_out[row]
                              : std::clamp(sum - found, 0., zeros * saved.error[row]);
  return std::abs(found + left_out - sum) <= share_within;
}

/// Fails unless the shares of a row, which is called `name`, are some and add up.
void require_row(const FactorMatrix& saved, Eigen::Index row, const std::string& name) {
  const double error = saved.error[row] + share_within;
  Eigen::Index column = 0;
  if (const double least = saved.factors.row(row).minCoeff(&column); least < -error)
    refuse(saved, fmt::format("the form factor from '{}' to '{}' is {}, which is negative by more "
                              "than its error",
                              name, saved.names[static_cast<std::size_t>(column)], least));
  if (saved.space[row] < -error)
    refuse(saved, fmt::format("the share of '{}' that goes to space is {}, which is negative by "
                              "more than its error",
                              name, saved.space[row]));
  // Rows that were enforced add up to one; what they added up to before is in row_sum.
  if (!adds_up_to(saved.row_sum[row], saved, row) && !adds_up_to(1, saved, row))
    refuse(saved,
           fmt::format("the form factors of '{}' and its space add up to {:.12g}, and the row's "
                       "sum is given as {:.12g}; the matrix has been changed, or its table is of "
                       "another one",
                       name, saved.factors.row(row).sum() + saved.space[row], saved.row_sum[row]));
  const auto entries = static_cast<double>(saved.area.size() + 1);
  if (!(std::abs(saved.row_sum[row] - 1) <= entries * error))
    refuse(saved,
           fmt::format("the form factors of '{}' and its space add up to {:.12g} instead of 1, "
                       "and no more than {:.2g} can be missing or too much by their error",
                       name, saved.row_sum[row], entries * error));
}

std::string text_of(const Vec3& v) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x(), v.y(), v.z());
}

/// Fails unless a face called `name` lies where it lay.
void require_place(const FactorMatrix& saved, const std::string& name, const RowPlace& there,
                   const RowPlace& here) {
  const auto differs = [&](const char* what, const Vec3& was, const Vec3& is) {
    refuse(saved, fmt::format("'{}' {} {} in the matrix and {} in the scene; they do not belong "
                              "together",
                              name, what, text_of(was), text_of(is)));
  };
  const auto is_near = [](const Vec3& a, const Vec3& b, double distance) {
    return (a - b).cwiseAbs().maxCoeff() <= distance;
  };
  const double distance = same_place * (here.centre.cwiseAbs().maxCoeff() + here.extent.maxCoeff());
  if (!is_near(there.centre, here.centre, distance))
    differs("has its centre at", there.centre, here.centre);
  if (!is_near(there.normal, here.normal, same_normal))
    differs("faces the way", there.normal, here.normal);
  if (!is_near(there.extent, here.extent, distance))
    differs("is turned: along the axes it extends over", there.extent, here.extent);
}

/// What was left out of rows; where the file does not tell, what misses to their sums.
Eigen::ArrayXd left_out_of(const FactorMatrix& saved) {
  if (saved.left_out.size() > 0) return saved.left_out;
  const Eigen::ArrayXd found = saved.factors.rowwise().sum().array() + saved.space;
  return ((found - 1).abs() <= share_within).select(0., saved.row_sum - found).max(0);
}

}  // namespace

void require_rows_that_add_up(const FactorMatrix& saved) {
  for (Eigen::Index row = 0; row < saved.area.size(); ++row)
    require_row(saved, row, saved.names[static_cast<std::size_t>(row)]);
}

RowMajorMatrix mutual_areas(const FactorMatrix& saved) {
  const Eigen::Index n = saved.area.size();
  RowMajorMatrix mutual = saved.area.matrix().asDiagonal() * saved.factors;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double there = mutual(i, j), back = mutual(j, i);
      if (!(std::abs(there - back) <= reciprocal_within * std::min(saved.area[i], saved.area[j])))
        refuse(saved, fmt::format("the form factors between '{}' and '{}' are not reciprocal: area "
                                  "times factor is {} one way and {} the other",
                                  saved.names[static_cast<std::size_t>(i)],
                                  saved.names[static_cast<std::size_t>(j)], there, back));
      mutual(i, j) = mutual(j, i) = 0.5 * (there + back);
    }
  return mutual;
}

void require_faces_of(const FactorScene& scene, const FactorMatrix& saved) {
  if (saved.names.size() != scene.names.size())
    refuse(saved, fmt::format("the matrix has {} rows and the scene {} faces; they do not belong "
                              "together, or the matrix is not by face",
                              saved.names.size(), scene.names.size()));
  for (std::size_t k = 0; k < scene.names.size(); ++k) {
    const double area = saved.area[static_cast<Eigen::Index>(k)];
    if (saved.names[k] != scene.names[k])
      refuse(saved,
             fmt::format("row {} of the matrix is '{}' where the scene has '{}'; they do not "
                         "belong together, or the matrix is not by face",
                         k + 1, saved.names[k], scene.names[k]));
    if (!(std::abs(area - scene.areas[k]) <= same_area * scene.areas[k]))
      refuse(saved, fmt::format("'{}' has an area of {} in the matrix and of {} in the scene; they "
                                "do not belong together",
                                saved.names[k], area, scene.areas[k]));
  }
  if (saved.places.empty()) return;
  const std::vector<RowPlace> places = row_places(scene);
  for (std::size_t k = 0; k < places.size(); ++k)
    require_place(saved, saved.names[k], saved.places[k], places[k]);
}

FactorMatrix summed_factors(const Scene& scene, const FactorMatrix& saved,
                            const FactorOptions& options) {
  const FactorScene faces = make_factor_scene(scene, FactorUnit::face);
  require_faces_of(faces, saved);
  FactorScene sums;
  sums.unit = scene.unit;
  sums.sound.repairs = faces.sound.repairs;
  sums.sound.face_lines = faces.sound.face_lines;
  const std::vector<int> row = sum_rows(scene, faces, options.unit, sums);
  FactorMatrix result =
      finished_matrix(sums, summed_exchange(saved, row, sums.rows()), HUGE_VAL, options);
  const auto mean = [&](const Eigen::ArrayXd& of_faces) {
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(result.area.size());
    for (std::size_t a = 0; a < row.size(); ++a) {
      const auto k = static_cast<Eigen::Index>(a);
      sum[row[a]] += saved.area[k] * of_faces[k];
    }
    return Eigen::ArrayXd(sum / result.area);
  };
  result.row_sum = mean(saved.row_sum);
  result.report.row_sum_error_max = (result.row_sum - 1).abs().maxCoeff();
  if (!result.report.is_enforced) result.left_out += mean(left_out_of(saved));
  if (options.unit == FactorUnit::face) result.places = row_places(faces);
  return result;
}

}  // namespace halfshade
