#include "solver/linear/classic_solvers.h"

#include "meshing/core/error.h"
#include "tests/support/analytic.h"
#include "tests/support/expect_error.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace halfshade {
namespace {

constexpr RadiositySolver all_solvers[] = {
    RadiositySolver::conjugate_gradients, RadiositySolver::jacobi, RadiositySolver::gauss_seidel,
    RadiositySolver::southwell, RadiositySolver::southwell_ambient};

/// A patch of a wall of the unit cube: the wall's axis and side, and where it lies in the others.
struct Patch {
  int axis = 0, side = 0;
  std::array<std::array<double, 2>, 3> range;  ///< along all axes; of its own, both the same
};

double exchanged_area(const Patch& a, const Patch& b, double area) {
  if (a.axis == b.axis) {
    if (a.side == b.side) return 0;
    const std::size_t u = at((a.axis + 1) % 3), v = at((a.axis + 2) % 3);
    return area *
           test::offset_parallel_rectangles(a.range[u], a.range[v], b.range[u], b.range[v], 1);
  }
  // Distances from the line where the walls meet, and ranges along it.
  const auto from_wall = [](const Patch& patch, const Patch& wall) {
    const auto& r = patch.range[at(wall.axis)];
    return wall.side == 0 ? r : std::array<double, 2>{1 - r[1], 1 - r[0]};
  };
  const std::size_t along = at(3 - a.axis - b.axis);
  return area * test::offset_perpendicular_rectangles(from_wall(a, b), a.range[along],
                                                      b.range[along], from_wall(b, a));
}

/// The unit cube, each wall of n² patches, with exact factors.
Exchange cube(int n) {
  std::vector<Patch> patches;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n * n; ++i) {
        Patch patch{axis, side, {}};
        const double u = i / n, v = i % n;
        patch.range[at(axis)] = {static_cast<double>(side), static_cast<double>(side)};
        patch.range[at((axis + 1) % 3)] = {u / n, (u + 1) / n};
        patch.range[at((axis + 2) % 3)] = {v / n, (v + 1) / n};
        patches.push_back(patch);
      }
  const auto count = static_cast<Eigen::Index>(patches.size());
  Eigen::MatrixXd matrix(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      matrix(i, j) = exchanged_area(patches[static_cast<std::size_t>(i)],
                                    patches[static_cast<std::size_t>(j)], 1. / (n * n));
  Exchange exchange;
  // Closed forms are off by 1e-12 or so.
  exchange.matrix = Eigen::MatrixXd(0.5 * (matrix + matrix.transpose())).sparseView();
  exchange.area = Eigen::ArrayXd::Constant(count, 1. / (n * n));
  EXPECT_LT((matrix.rowwise().sum().array() / exchange.area - 1).abs().maxCoeff(), 1e-9);
  EXPECT_TRUE(
      enforce_closure(exchange.matrix, exchange.area, std::vector<bool>(patches.size(), true)));
  exchange.lost = Eigen::ArrayXd::Zero(count);
  exchange.enclosures = {std::vector<int>(patches.size(), 0), {true}, {true}};
  return exchange;
}

const Exchange& fine_cube() {
  static const Exchange exchange = cube(8);
  return exchange;
}

/// One wall emits.
ChannelArray wall_light(Eigen::Index count) {
  ChannelArray exitance = ChannelArray::Zero(count, 3);
  exitance.topRows(count / 6) = 1;
  return exitance;
}

ChannelArray even(double rho, Eigen::Index count) { return ChannelArray::Constant(count, 3, rho); }

Solution solved(const Exchange& exchange, const ChannelArray& rho, RadiositySolver solver,
                double tolerance, int sweeps, RadiosityReport& report) {
  RadiosityOptions options;
  options.solver = solver;
  options.tolerance = tolerance;
  options.max_sweeps = sweeps;
  options.max_iterations = std::min(sweeps, 200);
  return solve_radiosity(exchange, rho, wall_light(rho.rows()), {}, options, report);
}

/// The first number of sweeps after which the radiosity is right to 1e-8 of its largest.
int sweeps_needed(double rho, RadiositySolver solver) {
  const Exchange& exchange = fine_cube();
  const ChannelArray rhos = even(rho, exchange.area.size());
  RadiosityReport report;
  const Solution right =
      solved(exchange, rhos, RadiositySolver::conjugate_gradients, 1e-14, 1000, report);
  const auto is_right = [&](int sweeps) {
    const Solution found = solved(exchange, rhos, solver, 1e-15, sweeps, report);
    return (found.radiosity - right.radiosity).abs().maxCoeff() <=
           1e-8 * right.radiosity.maxCoeff();
  };
  int too_few = 0, enough = 1;
  while (enough < 1000 && !is_right(enough)) too_few = std::exchange(enough, 2 * enough);
  while (enough - too_few > 1) {
    const int middle = (too_few + enough) / 2;
    (is_right(middle) ? enough : too_few) = middle;
  }
  return enough;
}

TEST(ClassicSolvers, TakeAsManySweepsAsTheyShould) {
  struct Known {
    double rho;
    double jacobi, gauss_seidel, southwell;
  };
  for (const Known& known : {Known{0.5, 23, 13, 11.8}, {0.8, 77, 40, 39}, {0.95, 355, 179, 178}}) {
    EXPECT_NEAR(sweeps_needed(known.rho, RadiositySolver::jacobi), known.jacobi,
                0.1 * known.jacobi + 1);
    EXPECT_NEAR(sweeps_needed(known.rho, RadiositySolver::gauss_seidel), known.gauss_seidel,
                0.1 * known.gauss_seidel + 1);
    EXPECT_NEAR(sweeps_needed(known.rho, RadiositySolver::southwell), known.southwell,
                0.1 * known.southwell + 1);
  }
  // Plain conjugate gradients take so many; ours have the balance of power to begin with.
  const struct {
    double rho;
    int most;
  } gradients[] = {{0.5, 9}, {0.8, 12}, {0.95, 14}, {0.999, 15}};
  for (const auto& known : gradients)
    EXPECT_LE(sweeps_needed(known.rho, RadiositySolver::conjugate_gradients), known.most);
}

TEST(ClassicSolvers, AllAgree) {
  const Exchange exchange = cube(3);
  const Eigen::Index count = exchange.area.size();
  test::Random random(1);
  ChannelArray mixed(count, 3);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index c = 0; c < 3; ++c) mixed(i, c) = random(0.05, 0.99);
  for (const ChannelArray& rho : {mixed, even(0.3, count), even(0.9, count), even(0, count)}) {
    RadiosityReport report;
    const Solution right =
        solved(exchange, rho, RadiositySolver::conjugate_gradients, 1e-13, 1000, report);
    for (const RadiositySolver solver : all_solvers) {
      const Solution found = solved(exchange, rho, solver, 1e-12, 100000, report);
      EXPECT_LT((found.radiosity - right.radiosity).abs().maxCoeff(),
                1e-9 * right.radiosity.maxCoeff());
      EXPECT_TRUE(report.converged);
      for (const ChannelReport& channel : report.channel) {
        EXPECT_EQ(channel.history.size(), at(channel.iterations));
        EXPECT_LT(channel.balance, 1e-9);
        if (!channel.history.empty()) {
          EXPECT_LE(channel.history.back(), 1e-12);
        }
      }
    }
  }
}

TEST(ClassicSolvers, AmbientLightBringsShootingNearerFromTheStart) {
  const Exchange exchange = cube(4);
  const ChannelArray rho = even(0.8, exchange.area.size());
  RadiosityReport report;
  const Solution right =
      solved(exchange, rho, RadiositySolver::conjugate_gradients, 1e-13, 1000, report);
  const auto error = [&](RadiositySolver solver) {
    const Solution found = solved(exchange, rho, solver, 1e-15, 1, report);
    EXPECT_FALSE(report.converged);
    return (found.radiosity - right.radiosity).matrix().norm();
  };
  EXPECT_LT(error(RadiositySolver::southwell_ambient), 0.3 * error(RadiositySolver::southwell));
}

/// The cube with an opening: its last patches are gone.
Exchange opened(const Exchange& whole, Eigen::Index gone) {
  const Eigen::Index count = whole.area.size() - gone;
  Exchange open = whole;
  open.matrix = whole.matrix.topLeftCorner(count, count);
  open.area = whole.area.head(count).eval();
  const Eigen::VectorXd left = open.matrix * Eigen::VectorXd::Ones(count);
  open.lost = open.area - left.array();
  open.enclosures = {std::vector<int>(at(static_cast<int>(count)), 0), {false}, {true}};
  return open;
}

RadiosityReport shot_report(const Exchange& exchange, const ChannelArray& rho,
                            RadiositySolver solver, Solution& solution) {
  RadiosityOptions options;
  options.solver = solver;
  options.stages = true;
  RadiosityReport report;
  solution = solve_radiosity(exchange, rho, wall_light(rho.rows()), {}, options, report);
  return report;
}

TEST(ShootingStages, PowerIsSomewhereAtEveryStage) {
  const Exchange closed = cube(4), open = opened(closed, 5);
  test::Random random(3);
  for (const Exchange* exchange : {&closed, &open})
    for (const RadiositySolver solver :
         {RadiositySolver::southwell, RadiositySolver::southwell_ambient}) {
      ChannelArray rho(exchange->area.size(), 3);
      for (Eigen::Index i = 0; i < rho.rows(); ++i)
        for (Eigen::Index c = 0; c < 3; ++c) rho(i, c) = random(0, 0.95);
      Solution solution;
      const RadiosityReport report = shot_report(*exchange, rho, solver, solution);
      ASSERT_GT(report.stages.size(), 10u);
      EXPECT_LT(report.stages.size(), 40u);
      for (std::size_t c = 0; c < 3; ++c) {
        const double emitted = report.channel[c].emitted_power;
        double shot = 0;
        for (const RadiosityStage& stage : report.stages) {
          const StagePower& power = stage.power[c];
          EXPECT_NEAR(power.unshot + power.absorbed + power.escaped, emitted, 1e-12 * emitted);
          EXPECT_LT(power.balance, 1e-12);
          EXPECT_GE(power.shot, shot);
          shot = power.shot;
        }
        const StagePower& last = report.stages.back().power[c];
        EXPECT_LT(last.unshot, 1e-9 * emitted);
        EXPECT_NEAR(last.absorbed, report.channel[c].absorbed_power, 1e-9 * emitted);
        EXPECT_NEAR(last.escaped, report.channel[c].escaped_power, 1e-9 * emitted);
        if (exchange == &closed) {
          EXPECT_NEAR(last.escaped, 0, 1e-12 * emitted);
        }
      }
      EXPECT_EQ(report.stages.front().shots, 0);
      EXPECT_TRUE((report.stages.front().irradiance == 0).all());
      EXPECT_TRUE(report.stages.back().irradiance.isApprox(solution.irradiance, 1e-8));
    }
}

TEST(ShootingStages, LightOnlyGrowsWithoutAmbientTermAndIsNearerWithIt) {
  const Exchange exchange = cube(4);
  const ChannelArray rho = even(0.8, exchange.area.size());
  Solution solution, with;
  const RadiosityReport plain = shot_report(exchange, rho, RadiositySolver::southwell, solution);
  const RadiosityReport ambient =
      shot_report(exchange, rho, RadiositySolver::southwell_ambient, with);
  for (std::size_t k = 1; k < plain.stages.size(); ++k) {
    const RadiosityStage& stage = plain.stages[k];
    EXPECT_TRUE((stage.irradiance >= plain.stages[k - 1].irradiance).all());
    EXPECT_EQ(stage.power[0].ambient, 0);
  }
  // A furnace with an even reflectance: what is spread evenly has the right mean.
  for (std::size_t k = 1; k + 1 < ambient.stages.size(); ++k) {
    EXPECT_NEAR(ambient.stages[k].irradiance.mean(), solution.irradiance.mean(),
                1e-9 * solution.irradiance.mean());
    EXPECT_LE((ambient.stages[k].irradiance - solution.irradiance).matrix().norm(),
              (plain.stages[k].irradiance - solution.irradiance).matrix().norm());
  }
}

TEST(ShootingStages, FirstShotsAreThoseOfTheDefinition) {
  const Exchange exchange = cube(2);
  const Eigen::Index count = exchange.area.size();
  const ChannelArray rho = even(0.5, count);
  Solution solution;
  const RadiosityReport report = shot_report(exchange, rho, RadiositySolver::southwell, solution);
  const Eigen::MatrixXd F =
      exchange.area.inverse().matrix().asDiagonal() * Eigen::MatrixXd(exchange.matrix);
  const Eigen::VectorXd direct = F * wall_light(count).col(0).matrix();
  ASSERT_EQ(report.stages[1].shots, count / 6);
  EXPECT_TRUE(report.stages[1].irradiance.col(0).matrix().isApprox(direct, 1e-14));
  Eigen::Index brightest = 0;
  const double sent = 0.5 * direct.maxCoeff(&brightest);
  ASSERT_EQ(report.stages[2].shots, count / 6 + 1);
  EXPECT_TRUE(report.stages[2].irradiance.col(0).matrix().isApprox(direct + sent * F.col(brightest),
                                                                   1e-14));
}

TEST(ClassicSolvers, NeedAMatrix) {
  const Exchange exchange = cube(1);
  LightExchange light = light_exchange(exchange);
  light.matrix = nullptr;
  RadiosityReport report;
  test::expect_error(
      [&] {
        solve_radiosity(light, even(0.5, 6), wall_light(6), {}, {.solver = RadiositySolver::jacobi},
                        report);
      },
      ErrorCode::contract, {"matrix"});
}

}  // namespace
}  // namespace halfshade
