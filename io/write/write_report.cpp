#include "io/write/write_report.h"

#include "io/files/atomic_file.h"
#include "io/files/consistency.h"
#include "io/write/result_formats.h"
#include "io/write/write_curves.h"
#include "io/write/write_mesh.h"
#include "meshing/patches/quality.h"
#include "meshing/repair/repair_sentence.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <set>

namespace halfshade {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Rgb& rgb) { return {rgb[0], rgb[1], rgb[2]}; }

Json scene_json(const SoundScene& scene, std::size_t cameras) {
  std::set<int> faces;
  for (const Surface& surface : scene.surfaces)
    faces.insert(surface.faces.begin(), surface.faces.end());
  return {{"faces", faces.size()},
          {"surfaces", scene.surfaces.size()},
          {"materials", scene.materials.size()},
          {"groups", scene.groups.size()},
          {"cameras", cameras},
          {"diagonal", scene.tolerance.scene_size}};
}

Json repairs_json(const SoundScene& scene) {
  Json json = Json::array();
  for (const Repair& repair : scene.repairs)
    json.push_back({{"kind", name_of(repair.kind)},
                    {"faces", repair.faces},
                    {"sentence", sentence(repair, scene)}});
  return json;
}

/// Shares of the area by smallest angle; what lies at input angles stands apart.
Json area_quality_json(const ElementTable& elements) {
  const AreaQuality quality = summarize_area_quality(elements);
  return {{"histogram", {{"bin_width", 5}, {"shares", quality.histogram}}},
          {"near_input_angles", quality.near_input_angles},
          {"good", quality.good},
          {"tolerable", quality.tolerable},
          {"min_angle", quality.min_angle}};
}

Json mesh_json(const ElementTable& elements) {
  const QualitySummary quality = summarize_quality(elements);
  return {{"elements", elements.count()},
          {"points", elements.points.size()},
          {"min_angle", quality.min_angle},
          {"mean_min_angle", quality.mean_angle},
          {"worst_element", quality.worst_element},
          {"longest_edge", quality.longest_edge},
          {"min_angle_histogram", {{"bin_width", 5}, {"counts", quality.histogram}}}};
}

Json stages_json(const std::vector<StageReport>& stages) {
  Json json = Json::array();
  for (const StageReport& stage : stages)
    json.push_back({{"name", stage.name},
                    {"seconds", stage.seconds},
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
          {"closure_error_max", report.closure_error_max},
          {"closure_error_rms", report.closure_error_rms},
          {"escaping_fraction", report.escaping_fraction},
          {"complete", report.complete}};
}

Json radiosity_json(const RadiosityReport& report) {
  Json channels = Json::array();
  for (const ChannelReport& channel : report.channel)
    channels.push_back({{"iterations", channel.iterations},
                        {"residual", channel.residual},
                        {"emitted_power", channel.emitted_power},
                        {"absorbed_power", channel.absorbed_power},
                        {"escaped_power", channel.escaped_power},
                        {"balance", channel.balance}});
  return {{"channels", report.channels},
          {"unknowns", report.unknowns},
          {"converged", report.converged},
          {"channel", channels}};
}

Json groups_json(const SolveResult& result) {
  struct Sums {
    double area = 0;
    Rgb radiosity = Rgb::Zero(), irradiance = Rgb::Zero();
    Rgb emitted = Rgb::Zero(), absorbed = Rgb::Zero();
  };
  std::vector<Sums> groups(result.scene.groups.size());
  const Solution& s = result.solution;
  for (int e = 0; e < result.elements.count(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    Sums& sums = groups.at(static_cast<std::size_t>(result.elements.group[i]));
    const double area = result.elements.area[i];
    const Rgb irradiance = s.irradiance.row(e);
    sums.area += area;
    sums.radiosity += area * s.radiosity.row(e).transpose();
    sums.irradiance += area * irradiance;
    sums.emitted += area * s.exitance.row(e).transpose();
    sums.absorbed += area * (1 - s.rho.row(e).transpose()) * irradiance;
  }
  Json json = Json::array();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Sums& sums = groups[g];
    const double area = sums.area > 0 ? sums.area : 1;  // a group without elements has zero light
    json.push_back({{"name", result.scene.groups[g]},
                    {"area", sums.area},
                    {"mean_radiosity", to_json(sums.radiosity / area)},
                    {"mean_irradiance", to_json(sums.irradiance / area)},
                    {"emitted_power", to_json(sums.emitted)},
                    {"absorbed_power", to_json(sums.absorbed)}});
  }
  return json;
}

Json search_json(const DiscontinuityReport& report) {
  Json found;
  for (std::size_t k = 0; k < report.found.size(); ++k)
    found[name_of(static_cast<CurveKind>(k))] = report.found[k];
  return {{"silhouette_edges", report.silhouette_edges},
          {"swaths", report.swaths},
          {"pieces", report.pieces},
          {"found", found},
          {"merged", report.merged},
          {"complete", !report.interrupted}};
}

Json along_curves_json(const DiscontinuityMeshReport& report) {
  return {{"kept", report.kept},
          {"culled", report.culled},
          {"deviation", report.deviation},
          {"boundary_rounds", report.boundary_rounds},
          {"unfinished_surfaces", report.unfinished_surfaces}};
}

/// How many there are of each kind and order, and how long they are together.
Json curves_json(const std::vector<DiscontinuityCurve>& curves) {
  struct Sums {
    std::size_t count = 0;
    double length = 0;
  };
  std::map<std::string, Sums> by_kind, by_order;
  for (const DiscontinuityCurve& curve : curves) {
    const double along = length(curve.arc);
    for (Sums* sums : {&by_kind[name_of(curve.kind)], &by_order[fmt::format("D{}", curve.order)]}) {
      ++sums->count;
      sums->length += along;
    }
  }
  const auto to_object = [](const std::map<std::string, Sums>& all) {
    Json json = Json::object();
    for (const auto& [name, sums] : all)
      json[name] = {{"count", sums.count}, {"length", sums.length}};
    return json;
  };
  return {
      {"total", curves.size()}, {"by_kind", to_object(by_kind)}, {"by_order", to_object(by_order)}};
}

Json sources_json(const MeshResult& result) {
  Json json = Json::array();
  for (const LightSource& source : result.found.sources) {
    const Surface& surface = result.scene.surfaces.at(static_cast<std::size_t>(source.surface));
    json.push_back({{"surface", source.surface},
                    {"group", result.scene.groups.at(static_cast<std::size_t>(surface.group))},
                    {"exitance", source.exitance},
                    {"area", area(surface)}});
  }
  return json;
}

Json to_json(const std::vector<std::filesystem::path>& paths) {
  Json json = Json::array();
  for (const auto& path : paths) json.push_back(path.string());
  return json;
}

void write(const Json& json, const std::filesystem::path& path) {
  // Names from files may be in any encoding.
  write_atomically(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace

void write_report(const SolveResult& result, const Provenance& provenance,
                  const std::vector<std::filesystem::path>& outputs,
                  const std::filesystem::path& path) {
  detail::require_consistent(result, "write_report");
  Json discontinuities = search_json(result.discontinuities);
  discontinuities["curves"] = result.curves;
  discontinuities["tolerance"] = result.discontinuity_tolerance;
  discontinuities.update(along_curves_json(result.mesh));
  write({{"version", provenance.version},
         {"command_line", provenance.command_line},
         {"unit", result.unit},
         {"interrupted", result.interrupted},
         {"estimated_relative_error", result.relative_error},
         {"scene", scene_json(result.scene, result.cameras.size())},
         {"repairs", repairs_json(result.scene)},
         {"discontinuities", discontinuities},
         {"mesh", mesh_json(result.elements)},
         {"stages", stages_json(result.stages)},
         {"exchange", exchange_json(result.exchange)},
         {"radiosity", radiosity_json(result.radiosity)},
         {"groups", groups_json(result)},
         {"outputs", to_json(outputs)}},
        path);
}

void write_report(const MeshResult& result, const Provenance& provenance,
                  const std::vector<std::filesystem::path>& outputs,
                  const std::filesystem::path& path) {
  detail::require_consistent(result.elements, "write_report");
  Json mesh = mesh_json(result.elements);
  mesh.update(along_curves_json(result.mesh));
  mesh["area_quality"] = area_quality_json(result.elements);
  mesh["irradiance_tolerance"] = result.irradiance_tolerance;
  write({{"version", provenance.version},
         {"command_line", provenance.command_line},
         {"unit", result.unit},
         {"interrupted", result.interrupted},
         {"scene", scene_json(result.scene, result.cameras.size())},
         {"repairs", repairs_json(result.scene)},
         {"sources", sources_json(result)},
         {"curves", curves_json(result.found.curves)},
         {"search", search_json(result.found.report)},
         {"mesh", mesh},
         {"stages", stages_json(result.stages)},
         {"outputs", to_json(outputs)}},
        path);
}

}  // namespace halfshade
