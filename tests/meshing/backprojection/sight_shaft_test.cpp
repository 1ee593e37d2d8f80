#include "meshing/backprojection/sight_shaft.h"

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/backprojection/sight_candidates.h"
#include "meshing/backprojection/visible_part.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

using test::Random;

constexpr int lamp = 0;

/// A lamp that is not convex over many small boxes, some of which reach through its plane.
SoundScene scene_of_boxes() {
  Random random(25);
  SoundScene scene = test::empty_sound_scene(4);
  test::add_surface(scene, {{{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, 0, 2}, {0, 0, 2}, {0, -1, 2}}},
                    1);
  test::add_surface(scene, {{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}}, 0);
  for (int k = 0; k < 200; ++k)
    for (const auto& face :
         test::random_box(random, random.in_box({-3, -3, 0.3}, {3, 3, 2.1}), 0.15))
      test::add_surface(scene, {face}, 0);
  return scene;
}

std::vector<Vec3> points_near(Random& random, const Vec3& place, double size, int count) {
  std::vector<Vec3> points;
  for (int k = 0; k < count; ++k)
    points.push_back(place + random.in_box({-size, -size, 0}, {size, size, size}));
  return points;
}

TEST(SightShaft, HoldsAllLinesFromItsPointsToTheEmitterAndLittleElse) {
  const OpaqueScene scene(scene_of_boxes());
  const OpaqueTopology& topology = scene.topology();
  const std::vector<BorderLine> lines = border_lines(topology, lamp);
  EXPECT_EQ(lines.size(), 6u);
  Random random(26);
  int far = 0, dropped = 0;
  for (int k = 0; k < 300; ++k) {
    const std::vector<Vec3> points =
        points_near(random, random.in_box({-3, -3, 0}, {3, 3, 1}), 0.3, 5);
    SightShaft shaft;
    shaft.make(topology.surfaces[lamp], lines, points);
    for (const Vec3& from : points) {
      const Vec3 to = random.in_box({-1, -1, 2}, {0, 1, 2});
      const Vec3 on_line = from + random(0, 1) * (to - from);
      EXPECT_FALSE(shaft.is_outside({on_line, on_line}));
      // Beside the pyramid over the lamp's bounding square, by more than all points lie apart.
      const double share = (2 - on_line.z()) / 2;
      const Vec3 beside(1 + 3 * share + 0.7, 0, on_line.z());
      const bool is_far = beside.x() > 1 + (from.x() + 0.7) * share + 0.7;
      far += is_far ? 1 : 0;
      dropped += is_far && shaft.is_outside({beside, beside}) ? 1 : 0;
    }
    const Vec3 beyond(0, 0, 2.01);
    EXPECT_TRUE(shaft.is_outside({beyond, beyond}));
  }
  EXPECT_GT(far, 500);
  EXPECT_GT(dropped, far * 9 / 10);
}

TEST(SightShaft, CandidatesOfSeveralPointsShowEachOfThemTheSame) {
  const OpaqueScene scene(scene_of_boxes());
  VisiblePartFinder finder(scene);
  Random random(27);
  const auto faces_of = [&](const SightCandidates& candidates) {
    int count = 0;
    for (const int node : candidates.nodes) count += scene.face_tree().nodes[at(node)].count;
    return count;
  };
  int penumbras = 0, narrowed = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 place = random.in_box({-3, -3, 0}, {3, 3, 1.8});
    const std::vector<Vec3> many = points_near(random, place, 1, 20);
    SightCandidates wide, narrow;
    finder.find_candidates(many, lamp, nullptr, wide);
    finder.find_candidates(std::span(many).first(4), lamp, &wide, narrow);
    narrowed += faces_of(narrow) < faces_of(wide) && 2 * faces_of(narrow) < 2400 ? 1 : 0;
    for (const Vec3& point : std::span(many).first(4)) {
      const Vec3 normal = random.direction();
      VisiblePart one, other;
      ASSERT_TRUE(finder.find_unless_crowded(point, normal, lamp, one));
      ASSERT_TRUE(finder.find_unless_crowded(point, normal, lamp, narrow, other));
      ASSERT_EQ(one.region, other.region);
      ASSERT_EQ(one.signature, other.signature);
      ASSERT_EQ(one.pieces.size(), other.pieces.size());
      for (std::size_t i = 0; i < one.pieces.size(); ++i) {
        ASSERT_EQ(one.pieces[i].from, other.pieces[i].from);
        ASSERT_EQ(one.pieces[i].to, other.pieces[i].to);
      }
      penumbras += one.region == Region::penumbra ? 1 : 0;
    }
  }
  EXPECT_GT(penumbras, 100);
  EXPECT_GT(narrowed, 200);
}

}  // namespace
}  // namespace halfshade
