#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "solver/exchange/exchange.h"
#include "tests/support/analytic.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stop_token>

namespace halfshade {
namespace {

/// A scene with elements no longer than `max_length`.
struct Pieces {
  SoundScene scene;
  ElementTable elements;

  Pieces(const Scene& input, double max_length) : scene(make_sound(input)) {
    PlanarMeshOptions options;
    options.max_length = max_length;
    elements = PatchMesh(scene, options).elements();
  }
  Exchange exchange(ExchangeOptions options, const Progress& progress = {}) const {
    return compute_exchange(scene, elements, VisibilityIndex(occluders(scene)), options, progress);
  }
};

Exchange left_as_it_is(const Pieces& pieces, FactorsBy factors, int pixels = 64) {
  ExchangeOptions options;
  options.factors = factors;
  options.hemicube_pixels = pixels;
  options.closure = Closure::leave;
  return pieces.exchange(options);
}

/// The relative difference of two exchanges, in the mean square over all pairs.
double difference(const Exchange& one, const Exchange& other) {
  return (one.matrix - other.matrix).norm() / other.matrix.norm();
}

Scene cube() {
  return test::room({1, 1, 1}, {{{.5, 1}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}}});
}

TEST(PointFactors, OfACubeAreNearTheClosedForms) {
  const Pieces pieces(cube(), 0.5);
  const Exchange pairs = left_as_it_is(pieces, FactorsBy::rays);
  const Exchange exact = left_as_it_is(pieces, FactorsBy::exact);
  const Exchange cubes = left_as_it_is(pieces, FactorsBy::hemicube, 64);
  EXPECT_EQ(exact.report.rays, 0u);
  EXPECT_EQ(cubes.report.rays, pieces.elements.corners.size() * 3 * 64 * 64);
  EXPECT_LT(difference(exact, pairs), 0.02);
  EXPECT_GT(difference(cubes, pairs), 2 * difference(exact, pairs))
      << "centroids alone do worse at the edges";
  EXPECT_LT(difference(cubes, pairs), 0.3);
}

TEST(PointFactors, ExactOnesSeeThroughAWindowAsRaysDo) {
  const Pieces pieces(test::l_room(true), 1);
  ExchangeOptions options;
  options.rays_per_pair = 512;
  options.closure = Closure::leave;
  const Exchange rays = pieces.exchange(options);
  EXPECT_LT(difference(left_as_it_is(pieces, FactorsBy::exact), rays), 0.04);
  EXPECT_LT(left_as_it_is(pieces, FactorsBy::exact).report.closure_error_rms, 0.02);
}

TEST(PointFactors, HemicubesComeNearerWithTheirPixels) {
  const Pieces pieces(test::l_room(true), 1.5);
  const Exchange fine = left_as_it_is(pieces, FactorsBy::hemicube, 128);
  const double coarse = difference(left_as_it_is(pieces, FactorsBy::hemicube, 8), fine);
  const double middle = difference(left_as_it_is(pieces, FactorsBy::hemicube, 32), fine);
  EXPECT_GT(coarse, 2 * middle);
  EXPECT_LT(middle, 0.05);
}

TEST(PointFactors, AreReciprocalAndCloseClosedRooms) {
  const Pieces pieces(test::l_room(true), 0.6);
  for (const FactorsBy factors : {FactorsBy::hemicube, FactorsBy::exact}) {
    const Exchange exchange = pieces.exchange({.factors = factors});
    const ExchangeMatrix transposed = exchange.matrix.transpose();
    EXPECT_EQ((exchange.matrix - transposed).norm(), 0);
    EXPECT_TRUE(exchange.report.closed);
    EXPECT_TRUE(exchange.report.closure_enforced);
    EXPECT_EQ(exchange.report.unfinished, 0);
    const Eigen::ArrayXd sums =
        (exchange.matrix * Eigen::VectorXd::Ones(exchange.area.size())).array();
    EXPECT_LE((sums / exchange.area - 1).abs().maxCoeff(), 1e-12);
    EXPECT_EQ(exchange.lost.abs().maxCoeff(), 0);
  }
}

TEST(PointFactors, NothingIsExchangedWithinASurfaceOrBehind) {
  const Pieces pieces(test::l_room(true), 0.8);
  for (const FactorsBy factors : {FactorsBy::hemicube, FactorsBy::exact}) {
    const Exchange exchange = left_as_it_is(pieces, factors);
    for (int e = 0; e < pieces.elements.count(); ++e)
      for (ExchangeMatrix::InnerIterator entry(exchange.matrix, e); entry; ++entry) {
        const auto i = static_cast<std::size_t>(e), j = static_cast<std::size_t>(entry.col());
        EXPECT_NE(pieces.elements.surface[i], pieces.elements.surface[j]);
        EXPECT_GT(entry.value(), 0);
      }
  }
}

TEST(PointFactors, StoppedOnesAreEstimatedInstead) {
  const Pieces pieces(cube(), 0.3);
  std::stop_source stop;
  Progress progress{stop.get_token(), [&](std::string_view, double) { stop.request_stop(); }};
  const Exchange exchange =
      pieces.exchange({.factors = FactorsBy::hemicube, .closure = Closure::leave}, progress);
  EXPECT_FALSE(exchange.report.complete);
  EXPECT_EQ(exchange.report.estimated_share, 1);
}

}  // namespace
}  // namespace halfshade
