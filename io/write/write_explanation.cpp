#include "io/write/write_explanation.h"

#include "io/files/atomic_file.h"
#include "io/write/report_parts.h"

#include <nlohmann/json.hpp>

namespace halfshade {
namespace {

using namespace detail;

Json or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json parts_json(const std::vector<SpacePart>& parts) {
  Json json = Json::array();
  for (const SpacePart& part : parts)
    json.push_back({{"groups", part.groups},
                    {"area", part.area},
                    {"closed", part.closed},
                    {"lit", part.lit},
                    {"swallowing", or_null(part.swallowing)}});
  return json;
}

Json planned_json(const std::vector<PlannedStage>& stages) {
  Json json = Json::array();
  for (const PlannedStage& stage : stages)
    json.push_back({{"name", stage.name},
                    {"left_out_because", or_null(stage.left_out_because)},
                    {"force", or_null(stage.force)},
                    {"amount", stage.amount},
                    {"what", stage.what},
                    {"seconds", stage.seconds},
                    {"how", or_null(stage.how)}});
  return json;
}

Json sources_json(const Explanation& explanation) {
  Json json = Json::array();
  for (const LightSource& source : explanation.plan.sources) {
    const Surface& surface = explanation.scene.surfaces[at(source.surface)];
    json.push_back({{"surface", source.surface},
                    {"group", explanation.scene.groups[at(surface.group)]},
                    {"exitance_w_per_m2", source.exitance},
                    {"area", area(surface)}});
  }
  return json;
}

}  // namespace

void write_explanation(const Explanation& explanation, const RunInfo& run,
                       const std::filesystem::path& path) {
  Json json = head_json(run);
  json["unit"] = explanation.unit;
  json["scene"] = scene_json(explanation.scene, {});
  json["scene"].erase("cameras");
  json["scene"].erase("camera_names");
  json["repairs"] = repairs_json(explanation.scene);
  json["warnings"] = warnings_json(explanation.warnings);
  json["channels"] = explanation.plan.no_channels.empty() ? 3 : 1;
  json["sources"] = sources_json(explanation);
  json["parts"] = parts_json(explanation.parts);
  json["stages"] = planned_json(explanation.stages);
  // Names from files may be in any encoding.
  write_atomically(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace halfshade
