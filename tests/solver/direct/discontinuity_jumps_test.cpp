#include "meshing/core/light_source.h"
#include "meshing/discontinuity/discontinuity.h"
#include "tests/support/degenerate_scenes.h"
#include "tests/support/effort.h"
#include "tests/support/one_sided_derivatives.h"
#include "tests/support/signature_bisection.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

// Jumps are where the curves say and as big as they say, measured with the exact irradiance from
// both sides.

namespace halfshade {
namespace {

using test::JumpMeter;
using test::MeasuredJump;
using test::NamedScene;

constexpr std::array<double, 3> jump_places = {1. / 6, 1. / 2, 5. / 6};

/// A measured jump must agree with a predicted one to `relative` of it, and to `absolute` of
/// the derivative's size, for jumps far below it are lost in rounding; below the
/// order of the curve nothing may jump by more than `smooth` of the size.
constexpr double relative = 1e-4, absolute = 1e-8, smooth = 1e-8;
/// Third derivatives are slopes of measured second ones, which are as good as this.
constexpr double absolute_of_slopes = 1e-10;

struct Tally {
  int measured = 0, crowded = 0, wrong = 0;
  std::array<int, 4> by_order{};
  std::array<int, curve_kinds> by_kind{};
  double worst = 0;  ///< relative error
};

/// Distance to whatever else there is in the receiver.
double clearance(const SoundScene& scene, const Discontinuities& found, std::size_t curve,
                 const Vec2& p) {
  const DiscontinuityCurve& own = found.curves[curve];
  double best =
      test::distance_to_border_lines(scene.surfaces[static_cast<std::size_t>(own.receiver)], p);
  for (std::size_t c = 0; c < found.curves.size(); ++c) {
    const DiscontinuityCurve& other = found.curves[c];
    if (c == curve || other.receiver != own.receiver || other.emitter != own.emitter) continue;
    best = std::min(best, distance(other.arc, p));
  }
  return best;
}

std::string describe(const NamedScene& named, const DiscontinuityCurve& curve, double s,
                     const MeasuredJump& measured, double exitance) {
  const PlaneFrame& frame = named.scene.surfaces[static_cast<std::size_t>(curve.receiver)].frame;
  const Vec3 at = frame.to_space(point_at(curve.arc, s));
  const auto& j = measured.jump;
  const auto& size = measured.scale;
  std::string text = fmt::format(
      "{}: receiver {}, light {}, kind {}, order {}, s = {:.3f} at ({:.12g}, {:.12g}, {:.12g}): "
      "predicted {:.9g} {:.9g} {:.9g}, measured {:.9g} {:.9g} {:.9g} {:.9g} (sizes {:.3g} {:.3g} "
      "{:.3g} {:.3g}, "
      "to ± {:.2g})",
      named.name, curve.receiver, curve.emitter, static_cast<int>(curve.kind), curve.order, s,
      at.x(), at.y(), at.z(), curve.jump[0], curve.jump[1], curve.jump[2], exitance * j[0],
      exitance * j[1], exitance * j[2], exitance * j[3], exitance * size[0], exitance * size[1],
      exitance * size[2], exitance * size[3], measured.reach);
  for (const CurveSource& source : curve.sources) {
    text += fmt::format("\n  kind {}:", static_cast<int>(source.kind));
    for (int i = 0; i < source.feature_count; ++i) {
      const Feature& f = source.features[static_cast<std::size_t>(i)];
      text += fmt::format(" {}:{}", static_cast<int>(f.kind), f.id);
    }
  }
  return text;
}

/// True if the measurement agrees.
bool agrees(const DiscontinuityCurve& curve, double predicted, const MeasuredJump& measured,
            double exitance, Tally& tally) {
  const auto k = static_cast<std::size_t>(curve.order);
  for (std::size_t below = 0; below < k; ++below) {
    const double size = measured.scale[below] + measured.reach * measured.scale[below + 1];
    if (std::abs(measured.jump[below]) > smooth * size + 1e-13) return false;
  }
  const double error = std::abs(exitance * measured.jump[k] - predicted);
  double allowed = relative * std::abs(predicted) + absolute * exitance * measured.scale[k];
  if (k == 3) allowed += absolute_of_slopes * exitance * measured.scale[2] / measured.reach;
  if (error > allowed) return false;
  tally.worst = std::max(tally.worst, error / (std::abs(predicted) + allowed));
  return true;
}

void measure_one(const NamedScene& named, const Discontinuities& found, std::size_t c, double s,
                 std::size_t place, const JumpMeter& meter, Tally& tally) {
  const DiscontinuityCurve& curve = found.curves[c];
  const auto source =
      std::find_if(found.sources.begin(), found.sources.end(),
                   [&](const LightSource& l) { return l.surface == curve.emitter; });
  ASSERT_NE(source, found.sources.end());
  const Vec2 at = point_at(curve.arc, s), along = tangent_at(curve.arc, s);
  const Vec2 left(-along.y(), along.x());
  const auto measured =
      meter.measure(curve.receiver, curve.emitter, at, left, clearance(named.scene, found, c, at));
  if (!measured) {
    ++tally.crowded;
    return;
  }
  ++tally.measured;
  ++tally.by_order[static_cast<std::size_t>(curve.order)];
  ++tally.by_kind[static_cast<std::size_t>(curve.kind)];
  if (agrees(curve, curve.jump[place], *measured, source->exitance, tally)) return;
  if (++tally.wrong <= 3) ADD_FAILURE() << describe(named, curve, s, *measured, source->exitance);
}

void measure_scene(const NamedScene& named, int count, Tally& tally) {
  const OpaqueScene opaque(named.scene);
  const std::vector<LightSource> sources = light_sources(named.scene);
  const Discontinuities found = find_discontinuities(named.scene, opaque, sources);
  ASSERT_FALSE(found.curves.empty()) << named.name;
  const DirectLightIndex index(named.scene);
  const JumpMeter meter(named.scene, index);
  test::Random random(5);
  Tally here;
  for (int i = 0; i < count; ++i) {
    const auto c =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(found.curves.size()) - 1));
    const auto place = static_cast<std::size_t>(random.integer(0, 2));
    measure_one(named, found, c, jump_places[place], place, meter, here);
  }
  EXPECT_LE(here.wrong, 0) << named.name << ": " << here.wrong << " of " << here.measured;
  EXPECT_GT(here.measured, here.crowded) << named.name;
  tally.measured += here.measured;
  tally.crowded += here.crowded;
  tally.worst = std::max(tally.worst, here.worst);
  for (std::size_t k = 0; k < 4; ++k) tally.by_order[k] += here.by_order[k];
  for (std::size_t k = 0; k < curve_kinds; ++k) tally.by_kind[k] += here.by_kind[k];
}

TEST(DiscontinuityJumps, AreAsPredicted) {
  Tally tally;
  for (const NamedScene& named : test::discontinuity_scenes())
    if (test::is_wanted(named.name)) measure_scene(named, 60 * test::effort(), tally);
  for (std::size_t k = 0; k < 4; ++k)
    RecordProperty("order_" + std::to_string(k), tally.by_order[k]);
  for (std::size_t k = 0; k < curve_kinds; ++k)
    RecordProperty("kind_" + std::to_string(k), tally.by_kind[k]);
  RecordProperty("worst", std::to_string(tally.worst));
  if (std::getenv("HALFSHADE_SCENE")) return;
  EXPECT_GT(tally.measured, 1000);
  EXPECT_GT(tally.by_order[1], 100);
  EXPECT_GT(tally.by_order[2], 300);
  EXPECT_GT(tally.by_kind[static_cast<std::size_t>(CurveKind::face)], 10);
  EXPECT_GT(tally.by_kind[static_cast<std::size_t>(CurveKind::ev)], 300);
  EXPECT_GT(tally.by_kind[static_cast<std::size_t>(CurveKind::eee)], 60);
}

/// There are few of them, so that all are measured.
TEST(DiscontinuityJumps, AlongTheHorizonAreOfTheThirdOrder) {
  Tally tally;
  for (const NamedScene& named :
       {NamedScene{"light_through_the_horizon", test::light_through_the_horizon()},
        NamedScene{"table_and_chairs", test::table_and_chairs_maker().sound()}}) {
    const OpaqueScene opaque(named.scene);
    const Discontinuities found =
        find_discontinuities(named.scene, opaque, light_sources(named.scene));
    const DirectLightIndex index(named.scene);
    const JumpMeter meter(named.scene, index);
    for (std::size_t c = 0; c < found.curves.size(); ++c)
      if (found.curves[c].kind == CurveKind::horizon)
        for (std::size_t place = 0; place < 3; ++place) {
          EXPECT_NE(found.curves[c].jump[place], 0) << named.name << ", curve " << c;
          measure_one(named, found, c, jump_places[place], place, meter, tally);
        }
  }
  RecordProperty("worst", std::to_string(tally.worst));
  EXPECT_EQ(tally.wrong, 0) << tally.measured;
  EXPECT_GT(tally.by_order[3], 20);
}

/// The receiver whose plane is z = 0.
int floor_of(const SoundScene& scene) {
  for (int r = 0; r < static_cast<int>(scene.surfaces.size()); ++r) {
    const PlaneFrame& frame = scene.surfaces[static_cast<std::size_t>(r)].frame;
    if (frame.normal.z() > 0.5 && std::abs(frame.origin.z()) < 1e-12) return r;
  }
  return -1;
}

struct TableRow {
  SoundScene scene;
  Vec2 at, across;
  CurveKind kind;
  int order;
  double jump;  ///< of the derivative of that order along `across`, which need not be of length 1
};

/// Values that other programs computed with quadruple precision from the visible area.
std::vector<TableRow> table() {
  std::vector<TableRow> rows;
  rows.push_back({test::s1(), {1.25, 0}, {1, 0}, CurveKind::ev, 1, -2.494278e-2});
  rows.push_back({test::s1(), {0.25, 0.05}, {1, 0}, CurveKind::ev, 1, 7.406901e-2});
  rows.push_back({test::one_triangle(), {2.3, 0.4}, {1, 0}, CurveKind::ev, 2, 1.515761e-2});
  rows.push_back({test::one_triangle(), {0.74, 0.3}, {0.5, 0.7}, CurveKind::ev, 2, 1.186442e-1});
  rows.push_back(
      {test::skew_bars_maker().sound(), {0.1, -0.3}, {1, 0}, CurveKind::eee, 2, 1.339969e-2});
  rows.push_back({test::face_plane(), {2.5, 0.05}, {0, 1}, CurveKind::face, 1, -2.89e-2});
  return rows;
}

TEST(DiscontinuityJumps, ThoseOfTheTableAreMeasured) {
  for (const TableRow& row : table()) {
    const DirectLightIndex index(row.scene);
    const int floor = floor_of(row.scene);
    const PlaneFrame& frame = row.scene.surfaces[static_cast<std::size_t>(floor)].frame;
    const Vec2 at = frame.to_plane({row.at.x(), row.at.y(), 0});
    const Vec3 direction(row.across.x(), row.across.y(), 0);
    const Vec2 across(frame.e1.dot(direction), frame.e2.dot(direction));
    const auto measured = JumpMeter(row.scene, index)
                              .measure(floor, index.emitters()[0], at, across.normalized(), 0.05);
    ASSERT_TRUE(measured);
    const auto k = static_cast<std::size_t>(row.order);
    const double scale = std::pow(across.norm(), row.order);
    // Four digits of the last one are known.
    const double digits = row.kind == CurveKind::face ? 2e-3 : 1e-6;
    EXPECT_NEAR(scale * measured->jump[k] / row.jump, 1, digits) << row.at.transpose();
    EXPECT_NEAR(scale * measured->from_values[k] / row.jump, 1, digits) << row.at.transpose();
    for (std::size_t below = 0; below < k; ++below) {
      EXPECT_NEAR(measured->jump[below], 0, 1e-12);
      EXPECT_NEAR(measured->from_values[below], 0, 1e-11);
    }
  }
}

TEST(DiscontinuityJumps, ThoseOfTheTableAreFound) {
  for (const TableRow& row : table()) {
    const OpaqueScene opaque(row.scene);
    const Discontinuities found = find_discontinuities(row.scene, opaque, light_sources(row.scene));
    const int floor = floor_of(row.scene);
    const PlaneFrame& frame = row.scene.surfaces[static_cast<std::size_t>(floor)].frame;
    const Vec2 at = frame.to_plane({row.at.x(), row.at.y(), 0});
    const Vec3 direction(row.across.x(), row.across.y(), 0);
    const Vec2 across(frame.e1.dot(direction), frame.e2.dot(direction));
    int here = 0;
    for (const DiscontinuityCurve& curve : found.curves) {
      if (curve.receiver != floor || distance(curve.arc, at) > 1e-9) continue;
      ++here;
      // Parallel edges make vertex–edge lines and lie in a plane.
      if (row.order == 2) {
        EXPECT_EQ(curve.kind, row.kind) << row.at.transpose();
      }
      EXPECT_EQ(curve.order, row.order) << row.at.transpose();
      // The jump varies along the arc: a parabola through its three values.
      double s = 0.5;
      for (double step = 0.25; step > 1e-12; step *= 0.5)
        s += (at - point_at(curve.arc, s)).dot(tangent_at(curve.arc, s)) > 0 ? step : -step;
      const Vec2 along = tangent_at(curve.arc, s);
      const double u = 3 * (s - 0.5);
      const double jump = 0.5 * u * (u - 1) * curve.jump[0] + (1 - u * u) * curve.jump[1] +
                          0.5 * u * (u + 1) * curve.jump[2];
      const double cosine = Vec2(-along.y(), along.x()).dot(across);
      const double along_row =
          row.order == 1 ? jump * std::abs(cosine) : jump * cosine * std::abs(cosine);
      EXPECT_NEAR(along_row / row.jump, 1, 0.05) << row.at.transpose() << " s = " << s;
    }
    EXPECT_EQ(here, 1) << row.at.transpose();
  }
}

/// S1's lines are known: eight segments between the corners of the umbra's and the penumbra's
/// lines.
TEST(DiscontinuityJumps, LinesOfASquareOverASquare) {
  const SoundScene scene = test::s1();
  const OpaqueScene opaque(scene);
  const Discontinuities found = find_discontinuities(scene, opaque, light_sources(scene));
  std::array<double, 8> covered{};
  const PlaneFrame& frame = scene.surfaces[2].frame;
  for (const DiscontinuityCurve& curve : found.curves) {
    if (curve.receiver != 2) continue;
    EXPECT_EQ(curve.order, 1);
    EXPECT_TRUE(curve.arc.is_straight);
    const Vec3 a = frame.to_space(curve.arc.from), b = frame.to_space(curve.arc.to);
    const int axis = std::abs(a.x() - b.x()) < std::abs(a.y() - b.y()) ? 0 : 1;
    int line = 0;
    for (const double place : {-1.25, -0.25, 0.25, 1.25}) {
      if (std::abs(a[axis] - place) < 1e-12 && std::abs(b[axis] - place) < 1e-12)
        covered[static_cast<std::size_t>(4 * axis + line)] += (a - b).norm();
      ++line;
    }
    for (const Vec3& p : {a, b}) EXPECT_LT(p.lpNorm<Eigen::Infinity>(), 1.25 + 1e-12);
  }
  for (const double length : covered) EXPECT_NEAR(length, 2.5, 1e-11);
  EXPECT_NEAR(std::accumulate(covered.begin(), covered.end(), 0.), 20, 1e-10);
}

}  // namespace
}  // namespace halfshade
