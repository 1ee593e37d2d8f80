#include "solver/reflected/hemisphere_rays.h"

#include "meshing/core/plane_frame.h"
#include "meshing/repair/repair.h"
#include "solver/elements/element_field.h"
#include "solver/exchange/form_factor.h"
#include "tests/support/room_families.h"
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
  const RayHemisphere hemisphere{from, 64, 1};
  const auto [ends, of_each] = trace_hemispheres(scene, {&hemisphere, 1});
  const int rays = of_each[0].rays;
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
  const RayHemisphere hemisphere{from, strata, 5};
  const auto [ends, of_each] = trace_hemispheres(scene, {&hemisphere, 1});
  ASSERT_EQ(of_each[0].rays, all);
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
    const RayHemisphere hemisphere{{{0.5, 0.5, 0}, Vec3::UnitZ()}, 32, 1};
    const auto [ends, of_each] = trace_hemispheres(reflecting, {&hemisphere, 1});
    const int rays = of_each[0].rays;
    EXPECT_EQ(rays, 32 * 32);
    const double expected = two_sided ? 0.2394564 : 0;  // unit squares, from the centre
    EXPECT_NEAR(static_cast<double>(ends.size()) / rays, expected, 4e-3);
    for (const RayEnd& end : ends) EXPECT_LT(reflecting.roots.normal[at(end.triangle)].z(), 0);
  }
}

TEST(HemisphereRays, MeetOfTwoSurfacesBackToBackTheOneThatFacesThem) {
  Scene scene;
  const int grey = test::add_material(scene, 0.5, 0);
  test::add_polygon(scene, {{0.2, 0.3, 0.1}, {1.2, 0.3, 0.4}, {1.2, 1.4, 0.4}, {0.2, 1.4, 0.1}},
                    grey);
  // Triangles along the other diagonal.
  test::add_polygon(scene, {{0.2, 1.4, 0.1}, {1.2, 1.4, 0.4}, {1.2, 0.3, 0.4}, {0.2, 0.3, 0.1}},
                    grey);
  const SoundScene sound = make_sound(scene);
  const ReflectingScene reflecting = make_reflecting_scene(sound);
  for (const double side : {-1., 1.}) {
    const Vec3 normal = -side * sound.surfaces[0].frame.normal;
    const RayHemisphere hemisphere{{Vec3(0.7, 0.9, 0.25) - 0.3 * normal, normal}, 64, 1};
    const auto [ends, of_each] = trace_hemispheres(reflecting, {&hemisphere, 1});
    const std::vector<Vec3>& corners = scene.vertices;
    const double expected = point_to_polygon(
        hemisphere.from.position, normal,
        side > 0 ? std::vector<Vec3>{corners[0], corners[1], corners[2], corners[3]}
                 : std::vector<Vec3>{corners[3], corners[2], corners[1], corners[0]});
    EXPECT_NEAR(static_cast<double>(ends.size()) / of_each[0].rays, expected, 4e-3);
    for (const RayEnd& end : ends)
      EXPECT_LT(reflecting.roots.normal[at(end.triangle)].dot(normal), 0);
  }
}

TEST(HemisphereRays, AreTheSameForTheSameSeedOnly) {
  const ReflectingScene scene = make_reflecting_scene(make_sound(test::room({1, 1, 1}, {})));
  const RayOrigin from{{0.3, 0.4, 0}, Vec3::UnitZ()};
  const std::vector<RayHemisphere> hemispheres = {{from, 4, 1}, {from, 4, 1}, {from, 4, 2}};
  const std::vector<RayEnd> ends = trace_hemispheres(scene, hemispheres).ends;
  ASSERT_EQ(ends.size(), 48U);
  for (std::size_t k = 0; k < 16; ++k) {
    EXPECT_EQ(ends[k].s, ends[k + 16].s);
    EXPECT_NE(ends[k].s, ends[k + 32].s);
  }
}

TEST(HemisphereRays, EndWhereTheyDoOneHemisphereAtATime) {
  const ReflectingScene scene = make_reflecting_scene(make_sound(test::furnished_room(100)));
  // More than go together at once, and fewer.
  for (const int strata : {3, 7, 50}) {
    std::vector<RayHemisphere> hemispheres;
    for (int k = 0; k < 9; ++k)
      hemispheres.push_back({{{0.5 + 0.1 * k, 0.7, 0}, Vec3::UnitZ()}, strata, at(k) + 5});
    const TracedHemispheres together = trace_hemispheres(scene, hemispheres);
    ASSERT_EQ(together.of_each.size(), hemispheres.size());
    for (std::size_t h = 0; h < hemispheres.size(); ++h) {
      const auto [ends, of_each] = trace_hemispheres(scene, {&hemispheres[h], 1});
      EXPECT_GT(ends.size(), at(strata * strata / 2));
      EXPECT_EQ(together.of_each[h].rays, of_each[0].rays);
      const std::span<const RayEnd> own = together.ends_of(h);
      ASSERT_EQ(own.size(), ends.size()) << strata << ' ' << h;
      for (std::size_t k = 0; k < ends.size(); ++k) {
        EXPECT_EQ(own[k].triangle, ends[k].triangle);
        EXPECT_EQ(own[k].s, ends[k].s);
        EXPECT_EQ(own[k].t, ends[k].t);
      }
    }
  }
}

}  // namespace
}  // namespace halfshade
