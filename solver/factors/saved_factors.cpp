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

}  // namespace

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
}

FactorMatrix summed_factors(const Scene& scene, const FactorMatrix& saved,
                            const FactorOptions& options) {
  const FactorScene faces = make_factor_scene(scene, FactorUnit::face);
  require_faces_of(faces, saved);
  FactorScene sums;
  sums.unit = scene.unit;
  const std::vector<int> row = sum_rows(scene, faces, options.unit, sums);
  FactorMatrix result =
      finished_matrix(sums, summed_exchange(saved, row, sums.rows()), HUGE_VAL, options);
  result.row_sum.setZero();
  for (std::size_t a = 0; a < row.size(); ++a) {
    const auto k = static_cast<Eigen::Index>(a);
    result.row_sum[row[a]] += saved.area[k] * saved.row_sum[k] / result.area[row[a]];
  }
  result.report.row_sum_error_max = (result.row_sum - 1).abs().maxCoeff();
  return result;
}

}  // namespace halfshade
