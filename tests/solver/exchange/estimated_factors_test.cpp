#include "solver/exchange/estimated_factors.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stop_token>

namespace halfshade {
namespace {

struct Meshed {
  SoundScene scene;
  ElementTable elements;
  VisibilityIndex visibility;

  Meshed(const Scene& input, double max_length)
      : scene(make_sound(input)), visibility(occluders(scene)) {
    PlanarMeshOptions options;
    options.max_length = max_length;
    elements = PatchMesh(scene, options).elements();
  }

  EstimatedFactors estimate(const std::vector<char>& is_missing) const {
    return estimate_factors(scene, elements, find_cells(scene, elements), visibility, is_missing);
  }
  EstimatedFactors estimate_all() const {
    return estimate(std::vector<char>(elements.area.size(), 1));
  }
  Exchange exact() const {
    return compute_exchange(scene, elements, visibility, {.closure = Closure::leave});
  }
};

Scene two_sided_screen_in_a_room() {
  Scene scene = test::l_room(false);
  const int screen = test::add_material(scene, 0.5, 0);
  scene.materials[at(screen)].two_sided = true;
  test::add_polygon(scene, {{0.7, 0.2, 0.3}, {0.7, 0.9, 0.3}, {0.7, 0.9, 0.8}, {0.7, 0.2, 0.8}},
                    screen);
  return scene;
}

/// Σ (estimate − exact)² / variance over the pairs that rays met, per pair.
double mean_square_of_deviations(const EstimatedFactors& estimate, const ExchangeMatrix& exact) {
  double sum = 0, count = 0;
  for (int i = 0; i < exact.rows(); ++i)
    for (ExchangeMatrix::InnerIterator entry(estimate.matrix, i); entry; ++entry) {
      const double deviation = entry.value() - exact.coeff(i, entry.col());
      sum += deviation * deviation / estimate.variance.coeff(i, entry.col());
      ++count;
    }
  return sum / count;
}

TEST(EstimatedFactors, AddUpToWhatIsExact) {
  for (const Scene& scene : {test::l_room(true), two_sided_screen_in_a_room()}) {
    const Meshed room(scene, 0.4);
    const EstimatedFactors estimate = room.estimate_all();
    const Exchange exact = room.exact();
    EXPECT_NEAR(estimate.matrix.sum(), exact.matrix.sum(), 0.01 * exact.matrix.sum());
    EXPECT_EQ((ExchangeMatrix(estimate.matrix.transpose()) - estimate.matrix).norm(), 0);
    // What light meets is told by pairs of surfaces.
    const auto surfaces = static_cast<Eigen::Index>(room.scene.surfaces.size());
    Eigen::MatrixXd by_surface = Eigen::MatrixXd::Zero(surfaces, surfaces), expected = by_surface;
    for (int i = 0; i < room.elements.count(); ++i)
      for (int j = 0; j < room.elements.count(); ++j) {
        const int a = room.elements.surface[at(i)], b = room.elements.surface[at(j)];
        by_surface(a, b) += estimate.matrix.coeff(i, j);
        expected(a, b) += exact.matrix.coeff(i, j);
      }
    EXPECT_LT((by_surface - expected).cwiseAbs().maxCoeff(), 0.015);
    const double deviation = mean_square_of_deviations(estimate, exact.matrix);
    EXPECT_LT(deviation, 1.5) << "the variance says how far off they are";
    EXPECT_GT(deviation, 0.1);
  }
}

TEST(EstimatedFactors, OpenScenesLoseWhatTheyLose) {
  Scene open = test::room({1, 1, 1}, {{{.5, 1}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}}});
  open.faces.pop_back();
  const Meshed room(open, 0.4);
  EXPECT_NEAR(room.estimate_all().matrix.sum(), 5 * 0.8, 0.04);
}

TEST(EstimatedFactors, AreOfMissingRowsOnly) {
  const Meshed room(test::l_room(true), 0.4);
  std::vector<char> is_missing(room.elements.area.size(), 0);
  const int count = room.elements.count();
  for (int e = count / 2; e < count; e += 2) is_missing[at(e)] = 1;
  const EstimatedFactors estimate = room.estimate(is_missing);
  EXPECT_GT(estimate.matrix.nonZeros(), 0);
  for (int i = 0; i < count; ++i)
    for (ExchangeMatrix::InnerIterator entry(estimate.matrix, i); entry; ++entry)
      EXPECT_TRUE(is_missing[at(std::min(i, static_cast<int>(entry.col())))]);
}

TEST(EstimatedFactors, TheErrorGrowsWithTheLight) {
  const Meshed room(test::l_room(true), 0.4);
  Exchange exchange = room.exact();
  const ChannelArray light = ChannelArray::Constant(room.elements.count(), 3, 2);
  EXPECT_TRUE((estimation_error(exchange, light) == 0).all());
  exchange.variance = room.estimate_all().variance;
  const Eigen::ArrayXd error = estimation_error(exchange, light);
  EXPECT_GT(error.minCoeff(), 0);
  EXPECT_LT(error.maxCoeff(), 2);
  EXPECT_TRUE(
      ((estimation_error(exchange, 1e200 * light) - 1e200 * error).abs() <= 1e-12 * 1e200 * error)
          .all());
  EXPECT_TRUE((estimation_error(exchange, 0 * light) == 0).all());
}

/// Stops the first time that it is told of a stage.
TEST(EstimatedFactors, FillWhatAStopLeavesOut) {
  const Meshed room(test::l_room(true), 0.25);
  std::stop_source stop;
  const Progress progress{stop.get_token(), [&](std::string_view, double) { stop.request_stop(); }};
  const Exchange exchange =
      compute_exchange(room.scene, room.elements, room.visibility, {}, progress);
  EXPECT_FALSE(exchange.report.complete);
  EXPECT_GT(exchange.report.estimated_share, 0);
  EXPECT_TRUE(exchange.report.closure_enforced);
  EXPECT_EQ(exchange.report.unfinished, 0);
  EXPECT_EQ(exchange.lost.abs().maxCoeff(), 0) << "the room is closed";
}

}  // namespace
}  // namespace halfshade
