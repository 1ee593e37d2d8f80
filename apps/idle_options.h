#pragma once

#include <initializer_list>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace halfshade {

/// An option that other options leave nothing to do.
struct IdleOption {
  const char* name;
  std::vector<std::string> fine{};  ///< values that ask for nothing but what is done anyway
};

/// Whether the command line has this option.
bool is_given(const CLI::App& app, const char* name);

/// Appends to `notes` a sentence, which says `why`, for each of `idle` that is given a value that
/// is not fine: what has no effect must not be thought to have one.
void note_idle(const CLI::App& app, std::initializer_list<IdleOption> idle, const std::string& why,
               std::vector<std::string>& notes);

}  // namespace halfshade
