#include "io/write/report_parts.h"
#include "solver/pipeline/heat_sums.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace halfshade::detail {
namespace {

Json channels_json(const Eigen::ArrayXd& values) {
  return std::vector<double>(values.begin(), values.end());
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
  const bool has_total = result.heat.bands.size() > 1;
  Json groups = Json::array();
  for (const GroupHeat& group : sums.groups) {
    const double area = group.area > 0 ? group.area : 1;
    Json json = {{"name", group.name},
                 {"area_m2", group.area},
                 {"net_flux_w_per_m2", channels_json(group.net_power / area)},
                 {"net_power_w", channels_json(group.net_power)},
                 {"temperature_k", number_or_null(group.temperature)}};
    if (has_total) json["total_net_power_w"] = group.net_power.sum();
    groups.push_back(std::move(json));
  }
  const std::optional<double>& space = result.heat.surroundings;
  Json json = {{"bands", bands_json(result.heat.bands)},
               {"unit_m", sums.metres},
               {"surroundings_temperature_k", space ? Json(*space) : Json()},
               {"surroundings_net_power_w", channels_json(-sums.to_space)}};
  if (has_total) json["surroundings_total_net_power_w"] = -sums.to_space.sum();
  json["groups"] = std::move(groups);
  return json;
}

}  // namespace halfshade::detail
