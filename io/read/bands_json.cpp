// Bands of the spectrum, which a materials file names.

#include "io/read/materials_json.h"
#include "io/read/read_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace halfshade::reading {
namespace {

using nlohmann::json;
using std::filesystem::path;

/// Each is solved for; more are no bands but a mistake.
constexpr std::size_t most_bands = 1000;

/// Of a band as an object: {"name": "solar", "wavelengths_um": [0.2, 3]}; null is without an end.
Band read_band(const json& value, const path& file, const std::string& key) {
  Band band;
  const json& name = value.is_object() && value.contains("name") ? value["name"] : value;
  if (!name.is_string() || name.get_ref<const std::string&>().empty())
    fail(file, 0, fmt::format("{} must be a name, or an object with a 'name'", key));
  band.name = name.get<std::string>();
  if (!value.is_object()) return band;
  require_known_keys(value, {"name", "wavelengths_um"}, file, key);
  const auto range = value.find("wavelengths_um");
  if (range == value.end()) return band;
  const bool is_range = range->is_array() && range->size() == 2 && (*range)[0].is_number() &&
                        ((*range)[1].is_number() || (*range)[1].is_null());
  if (is_range) {
    band.has_wavelengths = true;
    band.shortest = (*range)[0].get<double>();
    if ((*range)[1].is_number()) band.longest = (*range)[1].get<double>();
  }
  if (!is_range || !(band.shortest >= 0 && band.longest > band.shortest))
    fail(file, 0,
         fmt::format("{} must be two rising numbers in micrometres, or null for the second",
                     key_path(key, "wavelengths_um")));
  return band;
}

std::vector<Band> read_bands(const json& value, const path& file, const std::string& key) {
  if (value.empty() || value.size() > most_bands)
    fail(file, 0,
         fmt::format("{} has {} entries; there can be 1 to {} bands", key, value.size(),
                     most_bands));
  std::vector<Band> bands;
  for (std::size_t k = 0; k < value.size(); ++k) {
    bands.push_back(read_band(value[k], file, fmt::format("{}: band {}", key, k + 1)));
    for (std::size_t j = 0; j < k; ++j) {
      const Band &a = bands[j], &b = bands[k];
      if (a.name == b.name) fail(file, 0, fmt::format("{} has {} twice", key, in_quotes(a.name)));
      if (a.has_wavelengths && b.has_wavelengths && a.shortest < b.longest &&
          b.shortest < a.longest)
        fail(file, 0,
             fmt::format("{}: the wavelengths of {} and {} overlap", key, in_quotes(a.name),
                         in_quotes(b.name)));
    }
  }
  return bands;
}

}  // namespace

void take_bands(const json& value, const path& file, const std::string& key, SceneDraft& draft) {
  std::vector<Band> bands = read_bands(value, file, key);
  if (!draft.bands.empty() && draft.bands != bands)
    fail(file, 0, fmt::format("{} are other bands than those of the scene's sidecar", key));
  draft.bands = std::move(bands);
}

}  // namespace halfshade::reading
