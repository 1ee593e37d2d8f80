#include "io/write/write_curves.h"

#include "tests/support/files.h"
#include "tests/support/hand_made_curves.h"
#include "tests/support/vtk_structure.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkIdList.h>
#include <vtkPointData.h>

#include <cmath>
#include <limits>

namespace halfshade {
namespace {

using test::numbers;
using Numbers = std::vector<double>;

class WriteCurves : public testing::Test {
 protected:
  vtkSmartPointer<vtkPointSet> written(const Discontinuities& found, double deviation = 1e-4) {
    write_curves(scene_, found, path(), {deviation});
    test::expect_sound_vtk(path());
    return test::read_vtk(path());
  }
  std::filesystem::path path() const { return folder_.path() / "c.vtp"; }

  const SoundScene scene_ = test::s1();
  test::TempDir folder_;
};

TEST_F(WriteCurves, EachIsAPolylineFromEndToEnd) {
  const Discontinuities found = test::hand_made_curves();
  const auto grid = written(found);
  ASSERT_EQ(grid->GetNumberOfCells(), 3);
  vtkNew<vtkIdList> ids;
  const PlaneFrame& floor = scene_.surfaces[2].frame;
  for (vtkIdType c = 0; c < 3; ++c) {
    grid->GetCellPoints(c, ids);
    const ConicArc& arc = found.curves[static_cast<std::size_t>(c)].arc;
    EXPECT_EQ(grid->GetCellType(c), arc.is_straight ? VTK_LINE : VTK_POLY_LINE);
    ASSERT_GE(ids->GetNumberOfIds(), 2);
    EXPECT_EQ(Vec3(grid->GetPoint(ids->GetId(0))), floor.to_space(arc.from));
    EXPECT_EQ(Vec3(grid->GetPoint(ids->GetId(ids->GetNumberOfIds() - 1))), floor.to_space(arc.to));
    EXPECT_EQ(ids->GetNumberOfIds() == 2, arc.is_straight);
  }
}

TEST_F(WriteCurves, ConicsStayWithinTheDeviation) {
  const double size = std::hypot(3.7984, 3.7984);  // of the floor
  int before = 0;
  for (const double deviation : {1e-2, 1e-4, 1e-6}) {
    const auto grid = written(test::hand_made_curves(), deviation);
    vtkNew<vtkIdList> ids;
    grid->GetCellPoints(1, ids);
    const Vec2 centre = Vec2::Zero();
    const auto point = [&](vtkIdType k) {
      return scene_.surfaces[2].frame.to_plane(Vec3(grid->GetPoint(ids->GetId(k))));
    };
    for (vtkIdType k = 0; k + 1 < ids->GetNumberOfIds(); ++k) {
      EXPECT_NEAR((point(k) - centre).norm(), 1, 1e-12);
      // The chord is farthest from the circle in its middle.
      EXPECT_NEAR(((point(k) + point(k + 1)) / 2 - centre).norm(), 1, deviation * size);
    }
    EXPECT_GT(ids->GetNumberOfIds(), before);
    before = static_cast<int>(ids->GetNumberOfIds());
  }
}

TEST_F(WriteCurves, SaysWhatEachIsAndWhereItComesFrom) {
  const auto grid = written(test::hand_made_curves());
  vtkFieldData* cells = grid->GetCellData();
  EXPECT_EQ(numbers(cells, "kind"), (Numbers{2, 3, 0}));
  EXPECT_EQ(numbers(cells, "order"), (Numbers{1, 2, 0}));
  EXPECT_EQ(numbers(cells, "emitter"), (Numbers{0, 0, 0}));
  EXPECT_EQ(numbers(cells, "receiver"), (Numbers{2, 2, 2}));
  EXPECT_EQ(numbers(cells, "jump"), (Numbers{-0.2, 2, 0.5}));
  EXPECT_EQ(numbers(cells, "source_count"), (Numbers{2, 1, 1}));
  EXPECT_EQ(numbers(cells, "feature_kinds", 3), (Numbers{1, 3, -1, 1, 3, 3, 4, -1, -1}));
  EXPECT_EQ(numbers(cells, "feature_ids", 3), (Numbers{3, 2, -1, 0, 8, 9, 1, -1, -1}));
  const Numbers lengths = numbers(cells, "length");
  EXPECT_DOUBLE_EQ(lengths[0], 1);
  EXPECT_NEAR(lengths[1], M_PI / 2, 1e-4);
  EXPECT_DOUBLE_EQ(lengths[2], 0.75);
  vtkFieldData* field = grid->GetFieldData();
  EXPECT_EQ(numbers(field, "interrupted"), Numbers{0});
}

TEST_F(WriteCurves, JumpsRunAlongTheCurve) {
  const auto grid = written(test::hand_made_curves());
  const Numbers jump = numbers(grid->GetPointData(), "jump");
  ASSERT_EQ(jump.size(), static_cast<std::size_t>(grid->GetNumberOfPoints()));
  // −0.2 − 0.3 (s − 1/2), and constant on the contact line.
  EXPECT_NEAR(jump[0], -0.05, 1e-15);
  EXPECT_NEAR(jump[1], -0.35, 1e-15);
  EXPECT_EQ(jump.back(), 0.5);
}

TEST(JumpAt, IsTheParabolaThroughTheSamples) {
  DiscontinuityCurve curve;
  const auto parabola = [](double s) { return 3 + 2 * s - 5 * s * s; };
  curve.jump = {parabola(1. / 6), parabola(0.5), parabola(5. / 6)};
  for (const double s : {0., 0.2, 0.5, 0.7}) EXPECT_NEAR(jump_at(curve, s), parabola(s), 1e-14);
}

TEST(JumpAt, KeepsTheSignAndIsFinite) {
  DiscontinuityCurve curve;
  curve.jump = {1, 1, 9};  // the parabola dips below zero
  for (double s = 0; s <= 1; s += 0.01) EXPECT_GE(jump_at(curve, s), 0);
  curve.jump = {-1, -1, -9};
  for (double s = 0; s <= 1; s += 0.01) EXPECT_LE(jump_at(curve, s), 0);
  const double infinite = std::numeric_limits<double>::infinity();
  curve.jump = {1, -infinite, std::nan("")};
  for (double s = 0; s <= 1; s += 0.01) EXPECT_TRUE(std::isfinite(jump_at(curve, s)));
  EXPECT_EQ(jump_at(curve, 0.1), 1);
}

TEST_F(WriteCurves, ThereIsAFileWithoutCurvesToo) {
  Discontinuities none;
  none.report.interrupted = true;
  const auto grid = written(none);
  EXPECT_EQ(grid->GetNumberOfCells(), 0);
  EXPECT_EQ(numbers(grid->GetFieldData(), "interrupted"), Numbers{1});
}

TEST_F(WriteCurves, InfiniteJumpsComeOutFinite) {
  Discontinuities found = test::hand_made_curves();
  found.curves[1].jump.fill(std::numeric_limits<double>::infinity());
  const auto grid = written(found);
  for (const double jump : numbers(grid->GetPointData(), "jump")) EXPECT_TRUE(std::isfinite(jump));
  EXPECT_GT(numbers(grid->GetCellData(), "jump")[1], 1e38);
}

TEST_F(WriteCurves, DataAreInlineCompressedAndSealedAndTheSameEveryTime) {
  written(test::hand_made_curves());
  const std::string text = test::contents(path());
  EXPECT_NE(text.find("format=\"binary\""), std::string::npos);
  EXPECT_EQ(text.find("AppendedData"), std::string::npos);
  EXPECT_NE(text.find("vtkZLibDataCompressor"), std::string::npos);
  EXPECT_NE(text.find("<!-- halfshade checksum "), std::string::npos);
  written(test::hand_made_curves());
  EXPECT_EQ(test::contents(path()), text);
}

TEST_F(WriteCurves, RefusesWhatItCannotWrite) {
  const Discontinuities found = test::hand_made_curves();
  const auto write = [&](const Discontinuities& curves, const std::filesystem::path& to) {
    write_curves(scene_, curves, to);
  };
  test::expect_error([&] { write(found, folder_.path() / "c.vtu"); }, ErrorCode::usage,
                     {"c.vtu", ".vtp"});
  test::expect_error([&] { write(found, folder_.path() / "none" / "c.vtp"); },
                     ErrorCode::unwritable, {"none"});
  Discontinuities dangling = found;
  dangling.curves[1].receiver = 3;
  test::expect_error([&] { write(dangling, path()); }, ErrorCode::contract, {"receiver 3", "3"});
  dangling = found;
  dangling.curves[0].emitter = -1;
  test::expect_error([&] { write(dangling, path()); }, ErrorCode::contract, {"emitter -1"});
  test::expect_error([&] { write_curves(scene_, found, path(), {0}); }, ErrorCode::contract, {"0"});
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace halfshade
