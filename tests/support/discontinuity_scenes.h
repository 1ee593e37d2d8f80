#pragma once

#include "tests/support/furniture.h"
#include "tests/support/light_scenes.h"
#include "tests/support/random_scenes.h"
#include "tests/support/shadow_scenes.h"

#include <string>
#include <vector>

/// Scenes with every kind of shadow line.
namespace halfshade::test {

struct NamedScene {
  std::string name;
  SoundScene scene;
};

/// In general position, or nearly.
std::vector<NamedScene> discontinuity_scenes();

}  // namespace halfshade::test
