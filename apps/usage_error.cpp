#include "apps/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace halfshade {
namespace {

/// Of Damerau and Levenshtein, in its simple form: no letter is changed twice.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t changed = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + changed});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::string did_you_mean(const std::string& name) {
  return name.empty() ? "" : fmt::format("; did you mean '{}'?", name);
}

std::string unknown_command(const CLI::App& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  const std::string all = fmt::format("the commands are {}", fmt::join(names, ", "));
  const auto word = std::find_if(arguments.begin(), arguments.end(),
                                 [](const std::string& text) { return !text.starts_with('-'); });
  if (word == arguments.end()) return "a command is missing; " + all;
  const std::string name = nearest(*word, names);
  return fmt::format("there is no command '{}'{}", *word,
                     name.empty() ? "; " + all : did_you_mean(name));
}

/// The first argument that looks like an option and is none; empty if there is none.
std::string unknown_option(const CLI::App& command, const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    const bool looks_like_one =
        name.size() > 1 && name[0] == '-' && (name[1] == '-' || (name[1] >= 'A' && name[1] <= 'z'));
    if (looks_like_one && command.get_option_no_throw(name) == nullptr &&
        (name[1] == '-' || command.get_option_no_throw(name.substr(0, 2)) == nullptr))
      return name;
  }
  return {};
}

std::string sentence(const CLI::App& command, const CLI::ParseError& error,
                     const std::vector<std::string>& arguments) {
  const std::string what = error.what();
  constexpr std::string_view conversion = "Could not convert: ";
  if (what.starts_with(conversion))
    return fmt::format("{}: this value cannot be used", what.substr(conversion.size()));
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return what;
  const std::string option = unknown_option(command, arguments);
  if (!option.empty())
    return fmt::format("there is no option '{}'{}", option,
                       did_you_mean(nearest(option, option_names(command))));
  std::vector<std::string> extras = command.remaining();
  return fmt::format("'{}' is one argument too many", fmt::join(extras, " "));
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates)
    if (const std::size_t d = distance(word, candidate); d < least) {
      least = d;
      best = candidate;
    }
  return best;
}

std::string usage_error(const CLI::App& program, const CLI::ParseError& error,
                        const std::vector<std::string>& arguments) {
  const std::vector<CLI::App*> commands = program.get_subcommands();
  if (commands.empty()) return unknown_command(program, arguments) + "; see 'halfshade --help'";
  const std::string name = commands.front()->get_name();
  return fmt::format("{}: {}; see 'halfshade {} --help'", name,
                     sentence(*commands.front(), error, arguments), name);
}

}  // namespace halfshade
