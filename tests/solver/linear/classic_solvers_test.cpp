#include "solver/linear/classic_solvers.h"

#include "meshing/core/error.h"
#include "tests/support/expect_error.h"
#include "tests/support/fuzz_settings.h"
#include "tests/support/known_exchanges.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stop_token>

namespace halfshade {
namespace {

constexpr RadiositySolver all_solvers[] = {
    RadiositySolver::conjugate_gradients, RadiositySolver::jacobi, RadiositySolver::gauss_seidel,
    RadiositySolver::southwell, RadiositySolver::southwell_ambient};

const Exchange& fine_cube() {
  static const Exchange exchange = test::cube(8);
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

/// Errors of the fine cube's radiosity, relative to its largest, after numbers of sweeps.
class ErrorAfter {
 public:
  ErrorAfter(double rho, RadiositySolver solver)
      : solver_(solver), rho_(even(rho, fine_cube().area.size())) {
    RadiosityReport report;
    right_ = solved(fine_cube(), rho_, RadiositySolver::conjugate_gradients, 1e-14, 1000, report)
                 .radiosity;
  }
  double operator()(int sweeps) const {
    RadiosityReport report;
    const Solution found = solved(fine_cube(), rho_, solver_, 1e-15, sweeps, report);
    return (found.radiosity - right_).abs().maxCoeff() / right_.maxCoeff();
  }

 private:
  RadiositySolver solver_;
  ChannelArray rho_, right_;
};

constexpr double small_error = 1e-8;

/// The first number of sweeps after which the error is small.
int sweeps_needed(double rho, RadiositySolver solver) {
  const ErrorAfter error(rho, solver);
  int too_few = 0, enough = 1;
  while (enough < 1000 && error(enough) > small_error) too_few = std::exchange(enough, 2 * enough);
  while (enough - too_few > 1) {
    const int middle = (too_few + enough) / 2;
    (error(middle) > small_error ? too_few : enough) = middle;
  }
  return enough;
}

/// The same from how errors fall late in the iteration: each sweep leaves the same share of them.
double sweeps_predicted(double rho, RadiositySolver solver) {
  constexpr int late = 300, later = 400;
  const ErrorAfter error(rho, solver);
  const double left = error(late), rate = std::log(error(later) / left) / (later - late);
  return late + std::log(small_error / left) / rate;
}

struct KnownSweeps {
  double rho;
  double jacobi, gauss_seidel, southwell;  ///< shots over elements
};

TEST(ClassicSolvers, TakeAsManySweepsAsTheyShould) {
  for (const KnownSweeps& known :
       {KnownSweeps{0.5, 23, 13, 11.8}, {0.8, 77, 40, 39}, {0.95, 355, 179, 178}}) {
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
  } gradients[] = {{0.5, 9}, {0.8, 12}, {0.95, 14}, {0.99, 15}, {0.999, 15}};
  for (const auto& known : gradients)
    EXPECT_LE(sweeps_needed(known.rho, RadiositySolver::conjugate_gradients), known.most);
}

/// Predicted; HALFSHADE_SWEEPS=1 makes them, too, which takes a minute.
void expect_sweeps(double rho, RadiositySolver solver, double known) {
  EXPECT_NEAR(sweeps_predicted(rho, solver), known, 0.1 * known);
  if (test::fuzz_setting("HALFSHADE_SWEEPS", 0) == 0) return;
  const ErrorAfter error(rho, solver);
  EXPECT_GT(error(static_cast<int>(0.9 * known)), small_error);
  EXPECT_LT(error(static_cast<int>(1.1 * known)), small_error);
}

TEST(ClassicSolvers, TakeThousandsOfSweepsWhereHardlyAnythingIsAbsorbed) {
  EXPECT_NEAR(sweeps_predicted(0.95, RadiositySolver::jacobi), 355, 10);
  for (const KnownSweeps& known : {KnownSweeps{0.99, 1831, 917, 400}, {0.999, 18411, 9207, 400}}) {
    expect_sweeps(known.rho, RadiositySolver::jacobi, known.jacobi);
    expect_sweeps(known.rho, RadiositySolver::gauss_seidel, known.gauss_seidel);
    EXPECT_GT(sweeps_predicted(known.rho, RadiositySolver::southwell), known.southwell);
  }
}

TEST(ClassicSolvers, ClosePlatesConverge) {
  // Light goes to and fro many times before it leaves: the hard case of conjugate gradients.
  const struct {
    double gap;
    int gradients, jacobi;
  } all[] = {{0.3, 13, 46}, {0.1, 26, 174}, {0.03, 51, 671}};
  for (const auto& known : all) {
    SCOPED_TRACE(known.gap);
    const Exchange exchange = test::close_plates(known.gap, 16);
    const ChannelArray rho = even(0.99, exchange.area.size());
    RadiosityReport report;
    const Solution right =
        solved(exchange, rho, RadiositySolver::conjugate_gradients, 1e-10, 1000, report);
    EXPECT_TRUE(report.converged);
    EXPECT_NEAR(report.channel[0].iterations, known.gradients, 0.1 * known.gradients);
    EXPECT_LT(report.channel[0].balance, 1e-9);
    const Solution found = solved(exchange, rho, RadiositySolver::jacobi, 1e-10, 100000, report);
    EXPECT_TRUE(report.converged);
    EXPECT_NEAR(report.channel[0].iterations, known.jacobi, 0.1 * known.jacobi);
    EXPECT_LT((found.radiosity - right.radiosity).abs().maxCoeff(),
              1e-7 * right.radiosity.maxCoeff());
  }
}

void expect_agreement(const Exchange& exchange, const ChannelArray& rho) {
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

TEST(ClassicSolvers, AllAgreeInAnyScene) {
  const Exchange whole = test::cube(3);
  const Exchange scenes[] = {whole, test::opened(whole, 5), test::room_with_corner(),
                             test::close_plates(0.1, 6)};
  test::Random random(1);
  for (const Exchange& exchange : scenes) {
    SCOPED_TRACE(exchange.area.size());
    const Eigen::Index count = exchange.area.size();
    ChannelArray mixed(count, 3);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index c = 0; c < 3; ++c) mixed(i, c) = random(0.05, 0.99);
    for (const ChannelArray& rho : {mixed, even(0.3, count), even(0.9, count), even(0, count)})
      expect_agreement(exchange, rho);
  }
}

/// How far the reflected light of a run is off that was stopped after so many sweeps, and what it
/// claims; relative to what it found.
struct Stopped {
  double off, claimed;
};

Stopped stopped_after(int sweeps, RadiositySolver solver, const Exchange& exchange,
                      const ChannelArray& rho) {
  const auto area = exchange.area.replicate<1, 3>();
  const ChannelArray exitance = wall_light(rho.rows());
  std::stop_source at_once;
  at_once.request_stop();
  RadiosityOptions options;
  options.solver = solver;
  options.max_sweeps = std::max(sweeps, 1);
  const Progress progress{sweeps == 0 ? at_once.get_token() : std::stop_token(), {}};
  RadiosityReport report;
  const ChannelArray right =
      solved(exchange, rho, RadiositySolver::conjugate_gradients, 1e-13, 1000, report).radiosity;
  const ChannelArray found =
      solve_radiosity(exchange, rho, exitance, {}, options, report, progress).radiosity;
  return {(area * (found - right).abs()).sum() / (area * (found - exitance)).sum(),
          report.channel[0].error};
}

TEST(ClassicSolvers, KnowHowFarTheyAreWhereverTheyAreStopped) {
  const Exchange exchange = test::cube(4);
  for (const double rho : {0.5, 0.9, 0.985})
    for (const RadiositySolver solver :
         {RadiositySolver::jacobi, RadiositySolver::gauss_seidel, RadiositySolver::southwell})
      for (const int sweeps : {0, 1, 2, 5}) {
        const auto [off, claimed] =
            stopped_after(sweeps, solver, exchange, even(rho, exchange.area.size()));
        // One more exchange makes the light that is shown.
        EXPECT_LE(off, 1.001 * claimed) << rho << ' ' << sweeps;
        EXPECT_GE(3 * off, claimed) << rho << ' ' << sweeps;
      }
}

TEST(ClassicSolvers, DoNotClaimTooMuchWhereReflectancesDiffer) {
  for (const std::uint64_t seed : {1, 2, 3})
    for (const Exchange& exchange : {test::cube(4), test::opened(test::cube(4), 5)}) {
      test::Random random(seed);
      ChannelArray rho(exchange.area.size(), 3);
      for (auto row : rho.rowwise()) row.setConstant(random(0.05, 0.99));
      for (const RadiositySolver solver : {RadiositySolver::jacobi, RadiositySolver::southwell,
                                           RadiositySolver::southwell_ambient})
        for (const int sweeps : {0, 1, 2, 5}) {
          const auto [off, claimed] = stopped_after(sweeps, solver, exchange, rho);
          EXPECT_LE(off, claimed) << seed << ' ' << sweeps;
        }
    }
}

TEST(ClassicSolvers, AmbientLightBringsShootingNearerFromTheStart) {
  const Exchange exchange = test::cube(4);
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
  const Exchange closed = test::cube(4), open = test::opened(closed, 5);
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
  const Exchange exchange = test::cube(4);
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
  const Exchange exchange = test::cube(2);
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
  const Exchange exchange = test::cube(1);
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
