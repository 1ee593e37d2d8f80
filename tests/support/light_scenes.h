#pragma once

#include "tests/support/scene_maker.h"

/// Scenes whose lights are other than a square above the floor.
namespace halfshade::test {

SoundScene l_shaped_light();
/// Of four trapezoids that become one polygon.
SoundScene light_with_a_hole();
SoundScene tilted_light();
SoundScene two_lights();
/// A window in a wall that stands on the floor, and things before it.
SoundScene wall_light();
/// A light whose plane the floor crosses and that goes on below it: the floor is its horizon.
SoundScene light_through_the_horizon();

}  // namespace halfshade::test
