#pragma once

#include <string>
#include <vector>

namespace halfshade {

/// Names as a sentence has them: "walls, floor", of very many the first few and how many more.
std::string first_few(const std::vector<std::string>& names);

}  // namespace halfshade
