#include "io/write/report_parts.h"
#include "solver/pipeline/net_exchange.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <span>

namespace halfshade::detail {
namespace {

Json channels_json(const Rgb& values, int channels) {
  Json json = Json::array();
  for (int c = 0; c < channels; ++c) json.push_back(values[c]);
  return json;
}

Json bands_json(const std::vector<Band>& bands) {
  Json json = Json::array();
  for (const Band& band : bands) {
    Json one = {{"name", band.name}};
    if (band.has_wavelengths)
      one["wavelengths_um"] = {band.shortest,
                               std::isinf(band.longest) ? Json() : Json(band.longest)};
    json.push_back(one);
  }
  return json;
}

Json number_or_null(double value) { return std::isnan(value) ? Json() : Json(value); }

}  // namespace

Json net_exchange_json(const SolveResult& result) {
  const HeatSums sums = sum_heat(result);
  const int channels = channels_of(result);
  Json groups = Json::array();
  for (const GroupHeat& group : sums.groups) {
    const double area = group.area > 0 ? group.area : 1;
    groups.push_back({{"name", group.name},
                      {"area_m2", group.area},
                      {"net_flux_w_per_m2", channels_json(group.net_power / area, channels)},
                      {"net_power_w", channels_json(group.net_power, channels)},
                      {"temperature_k", number_or_null(group.temperature)}});
  }
  const std::optional<double>& space = result.heat.surroundings;
  return {{"bands", bands_json(result.heat.bands)},
          {"unit_m", sums.metres},
          {"surroundings_temperature_k", space ? Json(*space) : Json()},
          {"surroundings_net_power_w", channels_json(-sums.to_space, channels)},
          {"groups", groups}};
}

}  // namespace halfshade::detail
