#pragma once

#include "io/read/read_scene.h"
#include "tests/support/files.h"
#include "tests/support/random_scene.h"

namespace halfshade::test {

/// A scene of data/, or random_<seed>.
inline Scene named_scene(const std::string& name) {
  if (name.starts_with("random_")) return random_scene(std::stoul(name.substr(7)));
  return read_scene(data_file(name + ".obj")).scene;
}

}  // namespace halfshade::test
