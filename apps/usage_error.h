#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace halfshade {

/// What is wrong with a command line, as a sentence that names the option and ends with how to get
/// help; for what does not exist, with the nearest that does.
std::string usage_error(const CLI::App& program, const CLI::ParseError& error,
                        const std::vector<std::string>& arguments);

/// The candidate that takes the fewest letters changed, left out, put in or swapped; empty if that
/// is more than a third of the word's letters (or 1).
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace halfshade
