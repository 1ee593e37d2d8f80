// Checked values out of JSON files.

#include "io/read/materials_json.h"
#include "io/read/read_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace halfshade::reading {

using nlohmann::json;

namespace {

/// Follows the parser through objects and lists and finds keys that are there twice with values
/// that differ, of which the parser keeps the last.
class KeyWatch {
 public:
  bool operator()(json::parse_event_t event, const json& parsed) {
    using Event = json::parse_event_t;
    if (event == Event::object_start || event == Event::array_start)
      levels_.emplace_back();
    else if (event == Event::key)
      levels_.back().key = parsed.get<std::string>();
    else if (event == Event::value)
      note(parsed);
    else
      close(parsed);
    return true;
  }

  const std::string& contradiction() const { return contradiction_; }

 private:
  struct Level {
    std::string key;  ///< what comes next; in a list empty
    std::map<std::string, json> values;
  };

  void close(const json& parsed) {
    levels_.pop_back();
    note(parsed);
  }

  void note(const json& value) {
    if (levels_.empty() || levels_.back().key.empty()) return;
    const auto [known, is_new] = levels_.back().values.try_emplace(levels_.back().key, value);
    if (is_new || known->second == value || !contradiction_.empty()) return;
    for (const Level& level : levels_)
      if (!level.key.empty()) contradiction_ = key_path(contradiction_, level.key);
  }

  std::vector<Level> levels_;
  std::string contradiction_;
};

}  // namespace

json read_json(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  try {
    KeyWatch watch;
    json value = json::parse(
        bytes, [&](int, json::parse_event_t event, json& parsed) { return watch(event, parsed); },
        true, true);
    if (!watch.contradiction().empty())
      fail(path, 0, watch.contradiction() + " is there twice, with values that differ");
    return value;
  } catch (const json::parse_error& error) {
    const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(
                                         bytes.size(), error.byte > 0 ? error.byte - 1 : 0));
    const auto line = 1 + static_cast<int>(std::count(bytes.begin(), end, '\n'));
    // "[json.exception…] parse error at line 1, column 2: what is wrong"
    std::string what = error.what();
    if (const std::size_t column = what.find("column "); column != what.npos)
      if (const std::size_t colon = what.find(": ", column); colon != what.npos)
        what.erase(0, colon + 2);
    fail(path, line, "this is not JSON: " + what);
  } catch (const json::exception& error) {
    fail(path, 0, fmt::format("this is not JSON that can be used: {}", error.what()));
  }
}

std::string key_path(const std::string& outer, const std::string& key) {
  return outer.empty() ? in_quotes(key) : outer + ": " + in_quotes(key);
}

void require_object(const json& value, const std::filesystem::path& path, const std::string& key) {
  if (!value.is_object())
    fail(path, 0,
         fmt::format("{} is {} where an object {{…}} is expected",
                     key.empty() ? "the whole file" : key, value.type_name()));
}

void require_known_keys(const json& object, const std::vector<std::string>& known,
                        const std::filesystem::path& path, const std::string& key) {
  for (const auto& [name, value] : object.items())
    if (std::find(known.begin(), known.end(), name) == known.end())
      fail(path, 0,
           fmt::format("{} has the unknown key {}; known are {}", key, in_quotes(name),
                       listed(known)));
}

Vec3 vector_value(const json& value, const std::filesystem::path& path, const std::string& key) {
  Vec3 result = Vec3::Constant(NAN);
  if (value.is_array() && value.size() == 3)
    for (int c = 0; c < 3; ++c) {
      const json& number = value[static_cast<std::size_t>(c)];
      if (number.is_number()) result[c] = number.get<double>();
    }
  if (!result.allFinite()) fail(path, 0, fmt::format("{} must be three numbers [x, y, z]", key));
  return result;
}

}  // namespace halfshade::reading
