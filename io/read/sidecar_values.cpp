// Checked values out of JSON files.

#include "io/read/materials_json.h"
#include "io/read/read_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace halfshade::reading {

using nlohmann::json;

json read_json(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  try {
    return json::parse(bytes, nullptr, true, true);
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
