#include "io/write/report_parts.h"

#include "io/write/write_curves.h"
#include "meshing/patches/quality.h"
#include "meshing/repair/repair_sentence.h"

#include <nlohmann/json.hpp>

#include <map>
#include <set>
#include <span>

namespace halfshade::detail {
namespace {

template <class Thing>
std::vector<std::string> names_of(const std::vector<Thing>& things) {
  std::vector<std::string> names;
  for (const Thing& thing : things) names.push_back(thing.name);
  return names;
}

/// As sentences count them.
std::vector<int> counted_from_one(std::vector<int> faces) {
  for (int& face : faces) ++face;
  return faces;
}

}  // namespace

Json head_json(const RunInfo& run) {
  return {{"version", run.provenance.version},
          {"command_line", run.provenance.command_line},
          {"status", run.status},
          {"seconds", run.seconds},
          {"peak_memory_bytes", run.peak_memory_bytes}};
}

Json units_json(const std::string& unit) {
  return {{"length", unit}, {"area", unit + "²"}, {"power", "W/m² · " + unit + "²"}};
}

Json scene_json(const SoundScene& scene, const std::vector<Camera>& cameras) {
  std::set<int> faces;
  for (const Surface& surface : scene.surfaces)
    faces.insert(surface.faces.begin(), surface.faces.end());
  return {{"faces", faces.size()},
          {"surfaces", scene.surfaces.size()},
          {"materials", scene.materials.size()},
          {"groups", scene.groups.size()},
          {"cameras", cameras.size()},
          {"diagonal", scene.diagonal},
          {"material_names", names_of(scene.materials)},
          {"group_names", scene.groups},
          {"camera_names", names_of(cameras)}};
}

Json repairs_json(const SoundScene& scene) {
  Json json = Json::array();
  for (const Repair& repair : scene.repairs)
    json.push_back({{"kind", name_of(repair.kind)},
                    {"faces", counted_from_one(repair.faces)},
                    {"sentence", sentence(repair, scene)}});
  return json;
}

Json warnings_json(const std::vector<Warning>& warnings) {
  Json json = Json::array();
  for (const Warning& warning : warnings)
    json.push_back({{"kind", name_of(warning.kind)}, {"sentence", warning.sentence}});
  return json;
}

Json area_quality_json(const ElementTable& elements) {
  const AreaQuality quality = summarize_area_quality(elements);
  return {{"histogram", {{"bin_width_degrees", 5}, {"shares", quality.histogram}}},
          {"near_input_angles", quality.near_input_angles},
          {"good", quality.good},
          {"tolerable", quality.tolerable},
          {"min_angle_degrees", quality.min_angle}};
}

Json mesh_json(const ElementTable& elements) {
  const QualitySummary quality = summarize_quality(elements);
  return {{"elements", elements.count()},
          {"points", elements.points.size()},
          {"min_angle_degrees", quality.min_angle},
          {"mean_min_angle_degrees", quality.mean_angle},
          {"worst_element", quality.worst_element},
          {"longest_edge", quality.longest_edge},
          {"min_angle_histogram", {{"bin_width_degrees", 5}, {"counts", quality.histogram}}}};
}

Json stages_json(const std::vector<StageReport>& stages) {
  Json json = Json::array();
  for (const StageReport& stage : stages)
    json.push_back({{"name", stage.name},
                    {"seconds", stage.seconds},
                    {"cpu_seconds", stage.cpu_seconds},
                    {"count", stage.count},
                    {"left_out_because",
                     stage.left_out_because.empty() ? Json() : Json(stage.left_out_because)}});
  return json;
}

Json exchange_json(const ExchangeReport& report) {
  return {{"factors", report.factors},
          {"rays", report.rays},
          {"closed", report.closed},
          {"closure_enforced", report.closure_enforced},
          {"refined_rows", report.refined_rows},
          {"unfinished", report.unfinished},
          {"closure_error_max", report.closure_error_max},
          {"closure_error_rms", report.closure_error_rms},
          {"escaping_fraction", report.escaping_fraction},
          {"complete", report.complete},
          {"estimated_share", report.estimated_share}};
}

Json direct_json(const AdaptiveFieldReport& report, const ElementField& field) {
  std::map<int, int> orders;
  for (const int order : field.order) ++orders[order];
  Json by_order = Json::object();
  for (const auto& [order, count] : orders) by_order[std::to_string(order)] = count;
  return {{"elements_by_order", by_order},
          {"unknowns", report.unknowns},
          {"visibility", report.is_noisy ? "sampled" : "exact"},
          {"samples", report.samples},
          {"rounds", report.rounds},
          {"estimated_relative_error", report.relative_error}};
}

Json straight_json(const StraightCut& cut) {
  return {{"triangles", cut.pieces()}, {"relative_error_of_cutting", cut.relative_error}};
}

Json goal_json(const GoalResult& goal, const SoundScene& scene) {
  return {{"group", scene.groups.at(static_cast<std::size_t>(goal.group))},
          {"area", goal.area},
          {"mean_irradiance_w_per_m2", {goal.mean[0], goal.mean[1], goal.mean[2]}},
          {"estimated_relative_error", goal.relative_error},
          {"unknowns", goal.unknowns}};
}

Json reflected_json(const ReflectedReport& report) {
  return {{"elements", report.elements},
          {"unknowns", report.unknowns},
          {"rounds", report.rounds},
          {"visibility", report.is_exact ? "exact" : "sampled"},
          {"rays", report.rays},
          {"moments", report.moments},
          {"largest_row_error", report.row_error},
          {"systems", report.systems},
          {"closed_systems", report.closed_systems},
          {"iterations", report.iterations},
          {"residual", report.residual},
          {"amplification", report.amplification},
          {"estimated_relative_error", report.error},
          {"estimated_relative_error_of_rays", report.noise}};
}

namespace {

/// Of each stage of progressive refinement where the power is, by channel.
Json radiosity_stages_json(const RadiosityReport& report) {
  const auto numbers = [&](const RadiosityStage& stage, double StagePower::*number) {
    Json json = Json::array();
    for (std::size_t c = 0; c < at(report.channels); ++c) json.push_back(stage.power[c].*number);
    return json;
  };
  Json stages = Json::array();
  for (const RadiosityStage& stage : report.stages)
    stages.push_back({{"shots", stage.shots},
                      {"shot_power", numbers(stage, &StagePower::shot)},
                      {"unshot_power", numbers(stage, &StagePower::unshot)},
                      {"absorbed_power", numbers(stage, &StagePower::absorbed)},
                      {"escaped_power", numbers(stage, &StagePower::escaped)},
                      {"ambient_irradiance_w_per_m2", numbers(stage, &StagePower::ambient)},
                      {"balance", numbers(stage, &StagePower::balance)}});
  return stages;
}

}  // namespace

Json subdivision_json(const SubdivisionReport& report) {
  return {{"patches", report.patches}, {"elements", report.elements}};
}

Json radiosity_json(const RadiosityReport& report) {
  Json channels = Json::array();
  for (const ChannelReport& channel :
       std::span(report.channel).first(report.channels == 1 ? 1 : report.channel.size()))
    channels.push_back({{"iterations", channel.iterations},
                        {"history", channel.history},
                        {"residual", channel.residual},
                        {"error", channel.error},
                        {"emitted_power", channel.emitted_power},
                        {"absorbed_power", channel.absorbed_power},
                        {"escaped_power", channel.escaped_power},
                        {"balance", channel.balance}});
  Json json = {{"channels", report.channels},
               {"unknowns", report.unknowns},
               {"systems", report.systems},
               {"converged", report.converged},
               {"channel", channels}};
  if (!report.stages.empty()) json["stages"] = radiosity_stages_json(report);
  return json;
}

Json search_json(const DiscontinuityReport& report) {
  Json found, left_out = Json::object();
  for (std::size_t k = 0; k < report.found.size(); ++k) {
    const char* const name = name_of(static_cast<CurveKind>(k));
    found[name] = report.found[k];
    if (report.left_out[k] > 0) left_out[name] = report.left_out[k];
  }
  return {{"silhouette_edges", report.silhouette_edges},
          {"swaths", report.swaths},
          {"pieces", report.pieces},
          {"found", found},
          {"merged", report.merged},
          {"work", report.work},
          {"work_left_out", left_out},
          {"complete", !report.interrupted}};
}

Json along_curves_json(const DiscontinuityMeshReport& report) {
  return {{"kept", report.kept},
          {"culled", report.culled},
          {"deviation", report.deviation},
          {"boundary_rounds", report.boundary_rounds},
          {"unfinished_surfaces", report.unfinished_surfaces}};
}

}  // namespace halfshade::detail
