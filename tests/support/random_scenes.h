#pragma once

#include "tests/support/scene_maker.h"

#include <cstdint>

/// A square light, a floor, and `count` things between them that do not touch each other.
namespace halfshade::test {

SoundScene random_polygons(std::uint64_t seed, int count);
SoundScene random_boxes(std::uint64_t seed, int count);
SoundScene random_tetrahedra(std::uint64_t seed, int count);

}  // namespace halfshade::test
