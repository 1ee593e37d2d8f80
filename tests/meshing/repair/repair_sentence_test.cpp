#include "meshing/repair/repair_sentence.h"

#include <gtest/gtest.h>

#include <numeric>

namespace halfshade {
namespace {

SoundScene scene_with(int faces) {
  SoundScene scene;
  scene.face_lines.resize(at(faces));
  std::iota(scene.face_lines.begin(), scene.face_lines.end(), 10);
  return scene;
}

TEST(RepairSentence, NamesFacesAndValues) {
  const SoundScene scene = scene_with(3);
  using Kind = Repair::Kind;
  EXPECT_EQ(sentence({Kind::degenerate_dropped, {1}, 0.25}, scene),
            "face 2 (line 11) is thinner than 0.25 and was dropped");
  EXPECT_EQ(sentence({Kind::duplicate_dropped, {2, 0}}, scene),
            "face 3 (line 12) has the same corners as face 1 (line 10) and was dropped");
  EXPECT_EQ(sentence({Kind::non_planar_triangulated, {0}, 0.0032}, scene),
            "face 1 (line 10) is off its plane by 0.0032 and was triangulated");
  EXPECT_EQ(sentence({Kind::crossed_split, {0}}, scene),
            "the boundary of face 1 (line 10) crosses itself, so that it was split; its parts look "
            "to the side from which their corners run counter-clockwise");
  EXPECT_EQ(sentence({Kind::overlap_removed, {1, 0}, 12.5}, scene),
            "face 2 (line 11) and face 1 (line 10) lie in one plane and cover each other over an "
            "area of 12.5, which face 2 (line 11) keeps");
  EXPECT_EQ(sentence({Kind::gap_shut, {0, 2}, 1e-7}, scene),
            "face 1 (line 10) and face 3 (line 12) look at each other across a gap of 1e-07, too "
            "narrow for points so far from the origin or for faces so large, and count as "
            "touching");
  EXPECT_EQ(sentence({Kind::narrow_gap, {0, 2}, 1e-7}, scene),
            "face 1 (line 10) and face 3 (line 12) look at each other across a gap of 1e-07, which "
            "hardly any light enters; if they are meant to be back to back, give them the same "
            "corners");
}

TEST(RepairSentence, ShortensLongLists) {
  SoundScene scene = scene_with(9);
  scene.face_lines.assign(9, 0);
  Repair repair{Repair::Kind::coplanar_merged, {0, 1, 2, 3, 4, 5, 6, 7, 8}};
  EXPECT_EQ(sentence(repair, scene),
            "face 1, face 2, face 3, face 4, face 5, face 6, 3 more lie in one plane and were "
            "joined");
}

}  // namespace
}  // namespace halfshade
