#pragma once

#include "tests/architecture/source_text.h"

#include <string>
#include <vector>

namespace halfshade::test {

/// Nobody keeps more of a file in mind.
inline constexpr int most_lines = 400;

/// Lines of a text; the last one may lack its end.
int line_count(const std::string& text);

/// One sentence for each file of more than `most_lines` lines: its name and how many it has.
std::vector<std::string> too_long(const std::vector<SourceText>& files);

}  // namespace halfshade::test
