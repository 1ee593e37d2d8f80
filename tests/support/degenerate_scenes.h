#pragma once

#include "tests/support/discontinuity_scenes.h"

#include <vector>

/// Scenes in which many events coincide, or things touch.
namespace halfshade::test {

/// Boxes that share faces, edges and corners, all parallel to the axes and to the light.
inline SoundScene touching_boxes() {
  SceneMaker maker;
  maker.square_light()
      .box({-0.5, -0.5, 0}, {0, 0, 0.5})
      .box({0, -0.5, 0}, {0.5, 0, 0.25})   // shares a part of a face
      .box({0, 0, 0}, {0.5, 0.5, 0.5})     // shares an edge with the first
      .box({-0.5, 0, 0.5}, {0, 0.5, 1})    // stands on nothing; shares an edge with the first
      .box({0.5, 0.5, 0.5}, {1, 1, 0.75})  // shares a corner
      .box({-0.5, -0.5, 0.5}, {0, 0, 0.75});
  return maker.floor().sound();
}

/// In a closed room, with a box below.
inline SoundScene light_in_the_ceiling() {
  SceneMaker maker;
  for (const auto& face : box_faces({-1.6, -1.4, 0}, {1.5, 1.7, 2}, true)) maker.polygon(face);
  maker.down({-0.4, -0.5}, {0.5, 0.3}, 2, white_light).box({-0.3, -0.2, 0.5}, {0.3, 0.4, 1});
  return maker.sound();
}

/// A sheet hangs down from the light's corner, its upper edge through it; another one's edge runs
/// through the next corner from above to below the light's plane.
inline SoundScene edge_through_a_light_vertex() {
  SceneMaker maker;
  maker.square_light()
      .polygon({{0.2, 0.2, 2}, {0.8, 0.8, 2}, {0.8, 0.8, 1.2}, {0.2, 0.2, 1.2}})
      .polygon({{-0.5, -0.5, 1.5}, {-0.5, -0.5, 2.5}, {-1, -0.7, 2}});
  return maker.floor().sound();
}

/// Three edges that meet in (0, 0, 1) and go on; seen from everywhere they are concurrent.
inline SoundScene concurrent_edges() {
  SceneMaker maker;
  maker.square_light()
      .polygon({{-0.5, -0.1, 0.9}, {0.5, 0.1, 1.1}, {0.5, -0.4, 1.05}})
      .polygon({{0.1, -0.5, 1.1}, {-0.1, 0.5, 0.9}, {0.3, 0.55, 0.9}})
      .polygon({{-0.4, 0.4, 0.8}, {0.4, -0.4, 1.2}, {-0.45, -0.3, 1.2}});
  return maker.floor().sound();
}

/// A leaning sheet stands on the floor with its lower edge.
inline SoundScene standing_on_an_edge() {
  SceneMaker maker;
  maker.square_light()
      .polygon({{-0.5, 0.1, 0}, {0.4, -0.2, 0}, {0.5, 0.3, 0.8}, {-0.4, 0.6, 0.8}}, two_sided_grey)
      .polygon({{0.6, -0.6, 0}, {0.9, 0, 0}, {0.7, -0.4, 0.9}});
  return maker.floor().sound();
}

/// A tetrahedron stands on its tip, another on an edge.
inline SoundScene standing_on_a_vertex() {
  SceneMaker maker;
  maker.square_light()
      .tetrahedron({Vec3(0.1, 0.05, 0), {-0.3, -0.2, 0.6}, {0.5, -0.1, 0.7}, {0, 0.5, 0.65}})
      .tetrahedron({Vec3(-0.8, -0.3, 0), {-0.5, 0.3, 0}, {-0.9, 0.2, 0.5}, {-0.4, -0.2, 0.5}});
  return maker.floor().sound();
}

/// Each occluder twice, one pair the same way round, one back to back, one shifted in its plane.
inline SoundScene duplicated_occluders() {
  SceneMaker maker;
  maker.square_light();
  const std::vector<Vec3> a = {{-0.6, -0.3, 1}, {-0.1, -0.4, 1}, {-0.3, 0.2, 1}};
  const std::vector<Vec3> b = {{0.1, -0.3, 0.8}, {0.6, -0.2, 0.9}, {0.4, 0.5, 1}};
  maker.polygon(a).polygon(a).polygon(b).polygon({b.rbegin(), b.rend()});
  maker.up({-0.5, 0.4}, {0.1, 0.8}, 0.7).up({-0.2, 0.5}, {0.3, 0.9}, 0.7);
  return maker.floor().sound();
}

/// Small, so that the slivers are not welded: a light 1e-8 wide, and one of which occluders leave a
/// gap 1e-8 wide. (Light 1e-9 of the scene's size wide is dropped: see sliver_of_light.)
inline SoundScene slivers_of_light() {
  SceneMaker maker;
  maker.down({-0.5, -0.5}, {-0.5 + 1e-8, 0.5}, 2, bright_light)
      .down({-0.3, -0.5}, {0.5, 0.5}, 2, white_light)
      .up({-0.6, -0.6}, {0, 0.6}, 1)
      .up({1e-8, -0.6}, {0.5, 0.6}, 1);
  return maker.floor().sound();
}

/// 1e-9 wide.
inline SoundScene sliver_of_light() {
  SceneMaker maker;
  maker.down({-0.05, 0}, {0.05, 1e-9}, 0.2, bright_light)
      .polygon({{-0.02, -0.03, 0.1}, {0.05, 0, 0.1}, {0, 0.04, 0.12}});
  return maker.up({-0.2371, -0.2171}, {0.2613, 0.2413}, 0).sound();
}

inline SoundScene far_from_the_origin() {
  return skew_bars_maker().box({-0.2, 0.8, 0}, {0.3, 1.2, 0.5}).move({1e6, -1e6, 1e6}).sound();
}

/// A box through the light's plane and through the light's edge, a sheet through the floor and
/// through another sheet.
inline SoundScene cutting_each_other() {
  SceneMaker maker;
  maker.square_light()
      .turned_box({0.3, -0.3, 1.5}, {0.7, 0.2, 2.4}, 0.3)
      .polygon({{-0.6, -0.4, -0.3}, {0.1, -0.5, -0.2}, {-0.1, 0.1, 0.9}}, two_sided_grey)
      .polygon({{-0.7, 0.1, 0.2}, {0.4, -0.4, 0.3}, {-0.3, -0.4, 0.8}}, two_sided_grey);
  return maker.floor().sound();
}

/// The light touches the surface along an edge, and a box the light.
inline SoundScene light_on_the_floor() {
  SceneMaker maker;
  maker.polygon({{-1.5, -0.6, 0}, {-1.5, 0.6, 0}, {-1.5, 0.6, 1}, {-1.5, -0.6, 1}}, white_light);
  maker.standing_box({-1.5, -0.2, 0}, {-1.2, 0.1, 0.3}).box({-0.8, -0.3, 0.2}, {-0.4, 0.35, 0.6});
  return maker.up({-1.5, -2.0371}, {2.4613, 1.8613}, 0).sound();
}

inline std::vector<NamedScene> degenerate_scenes() {
  return {{"touching_boxes", touching_boxes()},
          {"light_in_the_ceiling", light_in_the_ceiling()},
          {"edge_through_a_light_vertex", edge_through_a_light_vertex()},
          {"concurrent_edges", concurrent_edges()},
          {"standing_on_an_edge", standing_on_an_edge()},
          {"standing_on_a_vertex", standing_on_a_vertex()},
          {"duplicated_occluders", duplicated_occluders()},
          {"slivers_of_light", slivers_of_light()},
          {"sliver_of_light", sliver_of_light()},
          {"far_from_the_origin", far_from_the_origin()},
          {"cutting_each_other", cutting_each_other()},
          {"light_on_the_floor", light_on_the_floor()}};
}

}  // namespace halfshade::test
