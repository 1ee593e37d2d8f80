#include "apps/command_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace halfshade {
namespace {

/// The number that all of the text is.
template <class Number>
std::optional<Number> parsed(const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// Refuses texts that are no number or for which `is_good` is false; `what` says what is wanted.
template <class Number, class IsGood>
CLI::Validator check(const std::string& what, IsGood is_good) {
  return {[what, is_good](const std::string& text) -> std::string {
            const std::optional<Number> value = parsed<Number>(text);
            return value && is_good(*value) ? "" : fmt::format("'{}' is not {}", text, what);
          },
          ""};
}

CLI::Option* add_real(CLI::App& app, const char* name, double& value, const CLI::Validator& valid,
                      const char* type, const char* help) {
  return app.add_option(name, value, help)->check(valid)->type_name(type);
}

/// Both ends of "lo,hi".
std::optional<ValueRange> parsed_range(const std::string& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const auto low = parsed<double>(text.substr(0, comma));
  const auto high = parsed<double>(text.substr(std::min(comma + 1, text.size())));
  if (!low || !high || !std::isfinite(*low) || !std::isfinite(*high)) return std::nullopt;
  return ValueRange{*low, *high};
}

}  // namespace

CLI::Option* add_whole(CLI::App& app, const char* name, int& value, std::array<int, 2> range,
                       const char* help) {
  const auto [least, most] = range;
  const std::string what = fmt::format("a whole number from {} to {}", least, most);
  return app.add_option(name, value, help)
      ->check(check<int>(what, [range](int v) { return v >= range[0] && v <= range[1]; }))
      ->type_name("N");
}

CLI::Option* add_whole_or_auto(CLI::App& app, const char* name, int& value,
                               std::array<int, 2> range, const char* help) {
  const auto is_auto = [](const std::string& text) {
    return CLI::detail::to_lower(text) == "auto";
  };
  const CLI::Validator is_good(
      [is_auto, range](const std::string& text) -> std::string {
        const auto given = parsed<int>(text);
        if (is_auto(text) || (given && *given >= range[0] && *given <= range[1])) return "";
        return fmt::format("'{}' is neither a whole number from {} to {} nor auto", text, range[0],
                           range[1]);
      },
      "");
  return app
      .add_option_function<std::string>(
          name,
          [is_auto, &value](const std::string& text) {
            if (!is_auto(text)) value = *parsed<int>(text);
          },
          help)
      ->check(is_good)
      ->default_str("auto")
      ->type_name("N|auto");
}

CLI::Option* add_even(CLI::App& app, const char* name, int& value, std::array<int, 2> range,
                      const char* help) {
  const std::string what = fmt::format("an even number from {} to {}", range[0], range[1]);
  const auto is_good = [range](int v) { return v >= range[0] && v <= range[1] && v % 2 == 0; };
  return app.add_option(name, value, help)->check(check<int>(what, is_good))->type_name("N");
}

CLI::Option* add_number(CLI::App& app, const char* name, double& value, std::array<double, 2> range,
                        const char* help) {
  const std::string what = fmt::format("a number from {} to {}", range[0], range[1]);
  const auto is_good = [range](double v) { return v >= range[0] && v <= range[1]; };
  return add_real(app, name, value, check<double>(what, is_good), "NUMBER", help);
}

CLI::Option* add_positive(CLI::App& app, const char* name, double& value, const char* help) {
  const auto is_good = [](double v) { return v > 0 && std::isfinite(v); };
  return add_real(app, name, value, check<double>("a number above zero", is_good), "NUMBER", help);
}

CLI::Option* add_not_negative(CLI::App& app, const char* name, double& value, const char* help) {
  const auto is_good = [](double v) { return v >= 0 && std::isfinite(v); };
  return add_real(app, name, value, check<double>("a number of at least zero", is_good), "NUMBER",
                  help);
}

CLI::Option* add_positives(CLI::App& app, const char* name, std::vector<double>& values,
                           const char* help) {
  const auto is_good = [](double v) { return v > 0 && std::isfinite(v); };
  // A delimiter of CLI11 would leave empty items out, and whoever forgot one would not notice.
  const auto check_all = [one = check<double>("a number above zero", is_good)](std::string& list) {
    for (const std::string& item : items({list}))
      if (const std::string wrong = one(item); !wrong.empty()) return wrong;
    return std::string();
  };
  const auto take = [&values](const std::vector<std::string>& lists) {
    values.clear();
    for (const std::string& item : items(lists)) values.push_back(*parsed<double>(item));
  };
  return app.add_option_function<std::vector<std::string>>(name, take, help)
      ->check(CLI::Validator(check_all, ""))
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("NUMBER,…");
}

CLI::Option* add_range(CLI::App& app, const char* name, std::optional<ValueRange>& value,
                       const char* help) {
  const CLI::Validator is_range(
      [](const std::string& text) -> std::string {
        const auto range = parsed_range(text);
        if (!range) return fmt::format("'{}' is not two numbers with a comma between them", text);
        return range->low < range->high ? ""
                                        : fmt::format(
                                              "'{}' does not rise: the lower end comes "
                                              "first",
                                              text);
      },
      "");
  return app
      .add_option_function<std::string>(
          name, [&value](const std::string& text) { value = parsed_range(text); }, help)
      ->check(is_range)
      ->type_name("LOW,HIGH");
}

CLI::Option* add_vector(CLI::App& app, const char* name, std::optional<Vec3>& value,
                        const char* help) {
  const auto is_good = [](double v) { return std::isfinite(v); };
  return app
      .add_option_function<std::vector<double>>(
          name, [&value](const std::vector<double>& v) { value = Vec3(v[0], v[1], v[2]); }, help)
      ->expected(3)
      ->check(check<double>("a finite number", is_good))
      ->type_name("X Y Z");
}

}  // namespace halfshade
