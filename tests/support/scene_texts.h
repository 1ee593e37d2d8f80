#pragma once

#include "io/read/read_scene.h"
#include "tests/support/files.h"

#include <string>
#include <string_view>
#include <vector>

/// Scenes that a test writes down as the text of a file.
namespace halfshade::test {

/// What is read from a file of this name and text, alone in its folder.
inline SceneFile read_text(const std::string& name, std::string_view text) {
  const TempDir folder;
  return read_scene(folder.write(name, text));
}

/// Expects that such a file is refused as invalid, with all of these parts in the message.
inline void expect_refused(const std::string& name, std::string_view text,
                           const std::vector<std::string>& parts) {
  expect_error([&] { read_text(name, text); }, ErrorCode::invalid_input, parts);
}

}  // namespace halfshade::test
