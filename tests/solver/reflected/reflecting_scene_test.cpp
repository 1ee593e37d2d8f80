#include "solver/reflected/reflecting_scene.h"

#include "meshing/core/plane_frame.h"
#include "meshing/repair/repair.h"
#include "solver/elements/element_field.h"
#include "solver/exchange/form_factor.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace halfshade {
namespace {

/// Share of the rays that ends on a surface.
double share_of(const ReflectingScene& scene, const std::vector<RayEnd>& ends, int rays,
                int surface) {
  double count = 0;
  for (const RayEnd& end : ends) count += scene.roots.surface[at(end.triangle)] == surface;
  return count / rays;
}

TEST(HemisphereRays, SharesAreFormFactors) {
  const SoundScene sound = make_sound(test::room({1, 1, 1}, {}));
  const ReflectingScene scene = make_reflecting_scene(sound);
  const RayOrigin from{{0.3, 0.4, 0}, Vec3::UnitZ(), scene.cells.before(0), true};
  std::vector<RayEnd> ends;
  const int rays = HemisphereRays(scene).cast(from, 64, 1, ends);
  EXPECT_EQ(rays, 64 * 64) << "nothing is lost";
  EXPECT_EQ(ends.size(), at(rays));
  const auto faces = test::box_faces(Vec3::Zero(), Vec3::Ones(), true);
  for (std::size_t f = 0; f < 6; ++f) {
    const double expected = point_to_polygon(from.position, from.normal, faces[f]);
    EXPECT_NEAR(share_of(scene, ends, rays, static_cast<int>(f)), expected, 2e-3) << f;
  }
}

/// The point of the unit square that on_disc takes to a point of the disc.
Vec2 in_square(const Vec2& d) {
  const double r = d.norm(), quarter = std::numbers::pi / 4;
  const bool wide = std::abs(d.x()) > std::abs(d.y());
  const double along = std::copysign(r, wide ? d.x() : d.y());
  const double across =
      along * (wide ? std::atan(d.y() / d.x()) : std::atan(d.x() / d.y())) / quarter;
  return 0.5 * (Vec2(wide ? along : across, wide ? across : along) + Vec2::Ones());
}

TEST(HemisphereRays, AreAloneInTheirCellsAndInTheirRowsAndColumns) {
  constexpr int strata = 8, all = strata * strata;
  const ReflectingScene scene = make_reflecting_scene(make_sound(test::room({1, 1, 1}, {})));
  const RayOrigin from{{0.3, 0.4, 0}, Vec3::UnitZ()};
  const PlaneFrame frame = make_frame(from.position, from.normal);
  std::vector<RayEnd> ends;
  ASSERT_EQ(HemisphereRays(scene).cast(from, strata, 5, ends), all);
  std::set<int> cells, rows, columns;
  for (const RayEnd& end : ends) {
    const Vec3 d =
        (position(scene.roots.triangle(end.triangle), end.place()) - from.position).normalized();
    const Vec2 p = in_square({d.dot(frame.e1), d.dot(frame.e2)});
    columns.insert(static_cast<int>(all * p.x()));
    rows.insert(static_cast<int>(all * p.y()));
    cells.insert(static_cast<int>(strata * p.x()) * strata + static_cast<int>(strata * p.y()));
  }
  EXPECT_EQ(cells.size(), at(all));
  EXPECT_EQ(rows.size(), at(all));
  EXPECT_EQ(columns.size(), at(all));
}

TEST(HemisphereRays, BacksSwallowAndTwoSidedSheetsDoNot) {
  for (const bool two_sided : {false, true}) {
    Scene scene;
    const int floor = test::add_material(scene, 0.5, 1), sheet = test::add_material(scene, 0.5, 0);
    scene.materials[at(sheet)].two_sided = two_sided;
    test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, floor);
    // Looks away from the floor.
    test::add_polygon(scene, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, sheet);
    const ReflectingScene reflecting = make_reflecting_scene(make_sound(scene));
    std::vector<RayEnd> ends;
    const RayOrigin from{{0.5, 0.5, 0}, Vec3::UnitZ()};
    const int rays = HemisphereRays(reflecting).cast(from, 32, 1, ends);
    EXPECT_EQ(rays, 32 * 32);
    const double expected = two_sided ? 0.2394564 : 0;  // unit squares, from the centre
    EXPECT_NEAR(static_cast<double>(ends.size()) / rays, expected, 4e-3);
    for (const RayEnd& end : ends) EXPECT_LT(reflecting.roots.normal[at(end.triangle)].z(), 0);
  }
}

TEST(HemisphereRays, AreTheSameForTheSameSeedOnly) {
  const ReflectingScene scene = make_reflecting_scene(make_sound(test::room({1, 1, 1}, {})));
  const RayOrigin from{{0.3, 0.4, 0}, Vec3::UnitZ()};
  std::vector<RayEnd> ends;
  HemisphereRays caster(scene);
  for (const std::uint64_t seed : {1, 1, 2}) caster.cast(from, 4, seed, ends);
  ASSERT_EQ(ends.size(), 48U);
  for (std::size_t k = 0; k < 16; ++k) {
    EXPECT_EQ(ends[k].s, ends[k + 16].s);
    EXPECT_NE(ends[k].s, ends[k + 32].s);
  }
}

}  // namespace
}  // namespace halfshade
