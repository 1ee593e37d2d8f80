#include "io/picture/picture.h"
#include "io/write/write_result.h"
#include "solver/elements/linear_pieces.h"
#include "solver/pipeline/linear_result.h"
#include "tests/support/files.h"
#include "tests/support/random.h"
#include "tests/support/sample_result.h"
#include "tests/support/vtk_structure.h"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkPointData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

/// 18 elements, two of each order, with coefficients that shrink by `shrink` from degree to degree.
SolveResult polynomial_result(double shrink) {
  SolveResult result = test::sample_result(3);
  test::Random random(31);
  std::vector<int> order;
  for (int e = 0; e < result.elements.count(); ++e) order.push_back(e % (max_order + 1));
  result.irradiance = result.direct = zero_field(order);
  for (int e = 0; e < result.elements.count(); ++e) {
    for (int degree = 0; degree <= order[at(e)]; ++degree)
      for (int k = basis_size(degree - 1); k < basis_size(degree); ++k)
        for (int c = 0; c < 3; ++c)
          result.direct.of(e)(k, c) = std::pow(shrink, degree) * random(-1, 1);
    result.direct.of(e).row(0) += 3;
    result.irradiance.of(e) = 1.5 * result.direct.of(e);
  }
  Solution& s = result.solution;
  s.direct_irradiance = means(result.direct);
  s.irradiance = means(result.irradiance);
  s.radiosity = s.exitance + s.rho * s.irradiance;
  return result;
}

Rgb radiosity_at(const SolveResult& result, int e, const TrianglePlace& place) {
  return (result.solution.exitance.row(e) +
          result.solution.rho.row(e) * value_at(result.irradiance, e, place).transpose())
      .transpose();
}

int cell_type(int order) {
  return order <= 1 ? VTK_TRIANGLE : order == 2 ? VTK_QUADRATIC_TRIANGLE : VTK_LAGRANGE_TRIANGLE;
}

/// What the values at a cell's points make of its weights.
Rgb interpolated(vtkPointSet* grid, vtkCell* cell, const char* name,
                 const std::vector<double>& weights) {
  vtkDataArray* values = grid->GetPointData()->GetArray(name);
  Rgb sum = Rgb::Zero();
  for (vtkIdType k = 0; k < cell->GetNumberOfPoints(); ++k)
    for (int c = 0; c < 3; ++c)
      sum[c] += weights[static_cast<std::size_t>(k)] *
                values->GetComponent(cell->GetPointId(static_cast<int>(k)), c);
  return sum;
}

TrianglePlace random_place(test::Random& random) {
  const double t = random(0, 1);
  return {random(0, 1 - t), t};
}

class WritePolynomials : public testing::Test {
 protected:
  vtkSmartPointer<vtkPointSet> written(const std::string& name, const ResultOptions& options = {}) {
    write_result(result_, {}, path(name), options);
    return test::read_vtk(path(name));
  }
  fs::path path(const std::string& name) const { return folder_.path() / name; }

  const SolveResult result_ = polynomial_result(0.6);
  test::TempDir folder_;
};

TEST_F(WritePolynomials, CellsHaveVtksTypesAndTheirOwnPoints) {
  const auto grid = written("a.vtu");
  test::expect_sound_vtk(path("a.vtu"));
  ASSERT_EQ(grid->GetNumberOfCells(), result_.elements.count());
  std::vector<int> used(static_cast<std::size_t>(grid->GetNumberOfPoints()), 0);
  for (int e = 0; e < result_.elements.count(); ++e) {
    const int order = result_.irradiance.order[at(e)];
    EXPECT_EQ(grid->GetCellType(e), cell_type(order)) << order;
    vtkCell* cell = grid->GetCell(e);
    ASSERT_EQ(cell->GetNumberOfPoints(), basis_size(std::max(order, 1))) << order;
    for (vtkIdType k = 0; k < cell->GetNumberOfPoints(); ++k)
      ++used[static_cast<std::size_t>(cell->GetPointId(static_cast<int>(k)))];
  }
  for (const int times : used) EXPECT_EQ(times, 1);
  EXPECT_EQ(test::numbers(grid->GetCellData(), "order"),
            std::vector<double>(result_.irradiance.order.begin(), result_.irradiance.order.end()));
}

TEST_F(WritePolynomials, VtkInterpolatesThePolynomials) {
  const auto grid = written("a.vtu");
  test::Random random(32);
  std::vector<double> weights(basis_size(max_order));
  for (int e = 0; e < result_.elements.count(); ++e) {
    vtkCell* cell = grid->GetCell(e);
    const auto triangle = result_.elements.triangle(e);
    for (int i = 0; i < 50; ++i) {
      const TrianglePlace place = random_place(random);
      const double local[3] = {place.x(), place.y(), 0};
      int part = 0;
      Vec3 x;
      cell->EvaluateLocation(part, local, x.data(), weights.data());
      EXPECT_LT((x - position(triangle, place)).norm(), 1e-12);
      const Rgb expected = value_at(result_.irradiance, e, place);
      const Rgb actual = interpolated(grid, cell, "irradiance", weights);
      EXPECT_LT((actual - expected).abs().maxCoeff(), 1e-12 * expected.abs().maxCoeff()) << e;
      const Rgb radiosity = radiosity_at(result_, e, place);
      EXPECT_LT((interpolated(grid, cell, "radiosity", weights) - radiosity).abs().maxCoeff(),
                1e-12 * radiosity.abs().maxCoeff())
          << e;
    }
  }
}

TEST_F(WritePolynomials, VtkFindsPlacesInThem) {
  const auto grid = written("a.vtu");
  test::Random random(33);
  std::vector<double> weights(basis_size(max_order));
  for (int e = 0; e < result_.elements.count(); ++e) {
    vtkCell* cell = grid->GetCell(e);
    const auto triangle = result_.elements.triangle(e);
    for (int i = 0; i < 20; ++i) {
      const TrianglePlace place = random_place(random);
      const Vec3 x = position(triangle, place);
      Vec3 closest, local;
      int part = 0;
      double distance = 1;
      ASSERT_EQ(cell->EvaluatePosition(x.data(), closest.data(), part, local.data(), distance,
                                       weights.data()),
                1)
          << e;
      EXPECT_LT(distance, 1e-20);
      EXPECT_LT((local.head<2>() - place).norm(), 1e-10) << e;
      const Rgb expected = value_at(result_.irradiance, e, place);
      EXPECT_LT((interpolated(grid, cell, "irradiance", weights) - expected).abs().maxCoeff(),
                1e-9 * expected.abs().maxCoeff())
          << e;
    }
  }
}

TEST_F(WritePolynomials, CellDataAreMeans) {
  const auto grid = written("a.vtu");
  for (const auto& [name, values] : {std::pair("irradiance", &result_.solution.irradiance),
                                     {"direct_irradiance", &result_.solution.direct_irradiance},
                                     {"radiosity", &result_.solution.radiosity}}) {
    const std::vector<double> read = test::numbers(grid->GetCellData(), name, 3);
    ASSERT_EQ(read.size(), static_cast<std::size_t>(values->size()));
    for (std::size_t i = 0; i < read.size(); ++i)
      EXPECT_EQ(read[i], (*values)(static_cast<Eigen::Index>(i / 3), static_cast<int>(i % 3)));
  }
}

TEST_F(WritePolynomials, OtherFilesHoldStraightTriangles) {
  const LinearResult linear = linear_result(result_);
  const auto count = static_cast<vtkIdType>(linear.elements.corners.size());
  EXPECT_GT(count, result_.elements.count());
  const auto expect_straight = [&](vtkPointSet* grid) {
    ASSERT_EQ(grid->GetNumberOfCells(), count);
    double area = 0;
    const auto irradiance = test::numbers(grid->GetPointData(), "irradiance", 3);
    ASSERT_EQ(irradiance.size(), static_cast<std::size_t>(linear.irradiance.size()));
    for (vtkIdType i = 0; i < count; ++i) {
      ASSERT_EQ(grid->GetCellType(i), VTK_TRIANGLE);
      std::array<Vec3, 3> corners;
      for (int k = 0; k < 3; ++k)
        grid->GetPoint(grid->GetCell(i)->GetPointId(k), corners[at(k)].data());
      area += (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2;
    }
    EXPECT_NEAR(area, 1, 1e-12);
    for (const double order : test::numbers(grid->GetCellData(), "order")) EXPECT_EQ(order, 1);
  };
  expect_straight(written("a.vtu", {.linear = true}));
  expect_straight(written("a.vtp"));
  expect_straight(written("b.vtp", {.linear = true}));
  for (const char* name : {"a.vtu", "a.vtp"}) test::expect_sound_vtk(path(name));

  write_result(result_, {}, path("a.ply"));
  const std::string ply = test::contents(path("a.ply"));
  EXPECT_NE(ply.find("element face " + std::to_string(count) + "\n"), std::string::npos);
  EXPECT_NE(ply.find("element vertex " + std::to_string(linear.elements.points.size()) + "\n"),
            std::string::npos);
}

/// Which element a point of the sample's unit square is in: it is told by a point inside a piece.
int element_at(const ElementTable& elements, const Vec3& point) {
  for (int e = 0; e < elements.count(); ++e) {
    const TrianglePlace place = place_of(elements.triangle(e), point);
    if (std::min({place.x(), place.y(), 1 - place.x() - place.y()}) > 0) return e;
  }
  return -1;
}

TEST_F(WritePolynomials, WhatIsDrawnIsClose) {
  const SolveResult result = polynomial_result(0.1);
  write_result(result, {}, path("a.vtu"));
  const ShadedMesh mesh = read_shaded(path("a.vtu"));
  EXPECT_GT(mesh.triangles.size(), result.elements.corners.size());
  ASSERT_EQ(mesh.triangle_value.size(), mesh.triangles.size());
  ASSERT_EQ(mesh.emits.size(), mesh.triangles.size());
  double largest = 0, area = 0;
  for (int e = 1; e < result.elements.count(); ++e)  // the first emits
    largest = std::max(largest, radiosity_at(result, e, {0.3, 0.3}).maxCoeff());
  test::Random random(34);
  std::vector<int> seen(result.elements.corners.size(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<Vec3, 3> corners;
    std::array<Rgb, 3> value;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = mesh.points[at(mesh.triangles[i][k])];
      value[k] = mesh.point_value[at(mesh.triangles[i][k])];
    }
    area += (corners[1] - corners[0]).cross(corners[2] - corners[0]).z() / 2;
    const int e = element_at(result.elements, (corners[0] + corners[1] + corners[2]) / 3);
    ASSERT_GE(e, 0);
    ++seen[at(e)];
    const auto exact = [&](const Vec3& p) {
      return radiosity_at(result, e, place_of(result.elements.triangle(e), p));
    };
    EXPECT_EQ(mesh.emits[i], e == 0 ? 1 : 0);
    EXPECT_TRUE((mesh.triangle_value[i].transpose() == result.solution.radiosity.row(e)).all());
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT((value[k] - exact(corners[k])).abs().maxCoeff(), 1e-11) << e;
    const TrianglePlace place = random_place(random);
    const Rgb drawn =
        value[0] + place.x() * (value[1] - value[0]) + place.y() * (value[2] - value[0]);
    EXPECT_LT((drawn - exact(position(corners, place))).abs().maxCoeff(),
              10 * invisible_share * largest)
        << e;
  }
  EXPECT_NEAR(area, 1, 1e-12);
  for (std::size_t e = 0; e < seen.size(); ++e) {
    EXPECT_GE(seen[e], 1) << e;
    EXPECT_LE(seen[e], 256) << e;
    if (result.irradiance.order[e] <= 1) {
      EXPECT_EQ(seen[e], 1) << e;
    }
  }
}

TEST_F(WritePolynomials, ConstantElementsAreDrawnConstant) {
  SolveResult result = test::sample_result(3);
  result.irradiance = result.direct =
      zero_field(std::vector<int>(result.elements.corners.size(), 0));
  result.irradiance.coefficients = result.solution.irradiance;
  result.direct.coefficients = result.solution.direct_irradiance;
  write_result(result, {}, path("a.vtu"));
  const auto grid = test::read_vtk(path("a.vtu"));
  const auto values = test::numbers(grid->GetPointData(), "irradiance", 3);
  for (int e = 0; e < result.elements.count(); ++e) {
    ASSERT_EQ(grid->GetCellType(e), VTK_TRIANGLE);
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c)
        EXPECT_DOUBLE_EQ(values[at(3 * (3 * e + k) + c)], result.solution.irradiance(e, c));
  }
  EXPECT_EQ(read_shaded(path("a.vtu")).triangles.size(), result.elements.corners.size());
}

TEST(WriteBounces, AreArraysThatAddUp) {
  SolveResult result = polynomial_result(0.5);
  result.bounces = {result.direct, result.direct};
  result.bounces[0].coefficients *= 0.3;
  result.bounces[1].coefficients *= 0.2;
  const test::TempDir folder;
  for (const auto& [name, linear] :
       {std::pair{"polynomials.vtu", false}, {"linear.vtu", true}, {"linear.vtp", false}}) {
    ResultOptions options;
    options.linear = linear;
    write_result(result, {}, folder.path() / name, options);
    const auto grid = test::read_vtk(folder.path() / name);
    ASSERT_TRUE(grid->GetPointData()->HasArray("irradiance_bounce_2")) << name;
    EXPECT_FALSE(grid->GetPointData()->HasArray("irradiance_bounce_3")) << name;
    const auto value = [&](const std::string& array, vtkIdType k, int c) {
      return grid->GetPointData()->GetArray(array.c_str())->GetComponent(k, c);
    };
    for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (const char number : {'0', '1', '2'})
          sum += value(std::string("irradiance_bounce_") + number, k, c);
        EXPECT_NEAR(sum, value("irradiance", k, c), 1e-5);
      }
  }
}

}  // namespace
}  // namespace halfshade
