#include "apps/idle_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>

namespace halfshade {

bool is_given(const CLI::App& app, const char* name) { return app.get_option(name)->count() > 0; }

void note_idle(const CLI::App& app, std::initializer_list<IdleOption> idle, const std::string& why,
               std::vector<std::string>& notes) {
  for (const IdleOption& option : idle)
    for (const std::string& value : app.get_option(option.name)->results()) {
      if (std::find(option.fine.begin(), option.fine.end(), CLI::detail::to_lower(value)) !=
          option.fine.end())
        continue;
      notes.push_back(fmt::format("{} changes nothing: it {}", option.name, why));
      break;
    }
}

}  // namespace halfshade
