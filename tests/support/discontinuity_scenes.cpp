#include "tests/support/discontinuity_scenes.h"

#include <cstdint>

namespace halfshade::test {

std::vector<NamedScene> discontinuity_scenes() {
  std::vector<NamedScene> all = {{"s1", s1()},
                                 {"one_triangle", one_triangle()},
                                 {"skew_bars", skew_bars_maker().sound()},
                                 {"three_skew_slats", three_skew_slats()},
                                 {"face_plane", face_plane()},
                                 {"bars", bars(4)},
                                 {"table_and_chairs", table_and_chairs_maker().sound()},
                                 {"boxes_on_floor", boxes_on_floor()},
                                 {"stacked_boxes", stacked_boxes()},
                                 {"l_shaped_light", l_shaped_light()},
                                 {"light_with_a_hole", light_with_a_hole()},
                                 {"tilted_light", tilted_light()},
                                 {"two_lights", two_lights()},
                                 {"wall_light", wall_light()},
                                 {"light_through_the_horizon", light_through_the_horizon()},
                                 {"sphere_of_triangles", sphere_of_triangles()},
                                 {"open_box", open_box()},
                                 {"window_in_a_sheet", window_in_a_sheet()},
                                 {"closed_room", closed_room()}};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    all.push_back({"polygons_" + std::to_string(seed), random_polygons(seed, 5)});
    all.push_back({"boxes_" + std::to_string(seed), random_boxes(seed, 4)});
    all.push_back({"tetrahedra_" + std::to_string(seed), random_tetrahedra(seed, 5)});
  }
  return all;
}

}  // namespace halfshade::test
