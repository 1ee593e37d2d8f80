#pragma once

#include <cstdlib>
#include <string_view>

/// The same tests with more samples, or on one scene: HALFSHADE_EFFORT=100 HALFSHADE_SCENE=bars.
namespace halfshade::test {

inline int effort() {
  const char* text = std::getenv("HALFSHADE_EFFORT");
  const int factor = text ? std::atoi(text) : 1;
  return factor > 0 ? factor : 1;
}

inline bool is_wanted(std::string_view scene) {
  const char* text = std::getenv("HALFSHADE_SCENE");
  return !text || scene == text;
}

}  // namespace halfshade::test
