#include "io/write/write_report.h"

#include "io/files/atomic_file.h"
#include "io/files/consistency.h"
#include "io/write/report_parts.h"
#include "io/write/write_curves.h"
#include "solver/heat/heat.h"
#include "solver/pipeline/straight_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <optional>

namespace halfshade {
namespace {

using namespace detail;

/// One number for each channel that differs.
Json to_json(const Rgb& rgb, bool grey) {
  return grey ? Json::array({rgb[0]}) : Json{rgb[0], rgb[1], rgb[2]};
}

Json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json to_json(const std::vector<std::filesystem::path>& paths) {
  Json json = Json::array();
  for (const auto& path : paths) json.push_back(path.string());
  return json;
}

/// What is told of every scene that was worked on.
template <class Result>
Json scene_head(const Result& result, const RunInfo& run) {
  Json json = head_json(run);
  json["unit"] = result.unit;
  json["units"] = units_json(result.unit);
  json["interrupted"] = result.interrupted;
  return json;
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
  const bool grey = result.radiosity.channels == 1;
  const std::optional<double> metres = metres_in(result.unit);
  Json json = Json::array();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Sums& sums = groups[g];
    const double area = sums.area > 0 ? sums.area : 1;  // a group without elements has zero light
    json.push_back({{"name", result.scene.groups[g]},
                    {"area", sums.area},
                    {"mean_radiosity_w_per_m2", to_json(sums.radiosity / area, grey)},
                    {"mean_irradiance_w_per_m2", to_json(sums.irradiance / area, grey)},
                    {"emitted_power", to_json(sums.emitted, grey)},
                    {"absorbed_power", to_json(sums.absorbed, grey)}});
    if (!metres) continue;
    const double square = *metres * *metres;
    json.back()["area_m2"] = square * sums.area;
    json.back()["emitted_power_w"] = to_json(square * sums.emitted, grey);
    json.back()["absorbed_power_w"] = to_json(square * sums.absorbed, grey);
  }
  return json;
}

/// Mean irradiance that was reflected 0, 1, … times.
Json bounces_json(const SolveResult& result) {
  const Eigen::Map<const Eigen::ArrayXd> areas(result.elements.area.data(),
                                               result.elements.count());
  Json json = Json::array();
  const auto add = [&](const ElementField& field) {
    const Rgb mean = (means(field).colwise() * areas).colwise().sum() / areas.sum();
    json.push_back({{"reflections", json.size()},
                    {"mean_irradiance_w_per_m2", to_json(mean, result.radiosity.channels == 1)}});
  };
  add(result.direct);
  for (const ElementField& field : result.bounces) add(field);
  return json;
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
                    {"exitance_w_per_m2", source.exitance},
                    {"area", area(surface)}});
  }
  return json;
}

void write(const Json& json, const std::filesystem::path& path) {
  // Names from files may be in any encoding.
  write_atomically(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace

void write_report(const SolveResult& result, const RunInfo& run,
                  const std::filesystem::path& path) {
  require_consistent(result, "write_report");
  Json json = scene_head(result, run);
  json["estimated_relative_error"] = error_of_files(result);
  json["accuracy_not_reached_because"] = result.not_reached;
  if (result.goal) json["goal"] = goal_json(*result.goal, result.scene);
  json["scene"] = scene_json(result.scene, result.cameras);
  json["repairs"] = repairs_json(result.scene);
  json["warnings"] = warnings_json(result.warnings);
  Json& discontinuities = json["discontinuities"] = search_json(result.discontinuities);
  discontinuities["curves"] = result.curves;
  discontinuities["tolerance"] = result.discontinuity_tolerance;
  discontinuities.update(along_curves_json(result.mesh));
  json["mesh"] = mesh_json(result.elements);
  json["stages"] = stages_json(result.stages);
  if (result.direct.count() > 0 && !result.interpolated) {
    json["direct_light"] = direct_json(result.refinement, result.direct);
    json["reflected_light"] = reflected_json(result.reflected);
  } else {
    json["exchange"] = exchange_json(result.exchange);
  }
  if (result.subdivision.patches > 0) json["subdivision"] = subdivision_json(result.subdivision);
  if (is_cut(result)) json["straight_triangles"] = straight_json(result.straight);
  json["radiosity"] = radiosity_json(result.radiosity);
  if (!result.bounces.empty()) json["bounces"] = bounces_json(result);
  json["groups"] = groups_json(result);
  if (result.heat.is_given) json["net_exchange"] = net_exchange_json(result);
  json["outputs"] = to_json(run.outputs);
  write(json, path);
}

void write_report(const MeshResult& result, const RunInfo& run, const std::filesystem::path& path) {
  require_consistent(result.elements, "write_report");
  Json json = scene_head(result, run);
  json["scene"] = scene_json(result.scene, result.cameras);
  json["repairs"] = repairs_json(result.scene);
  json["warnings"] = warnings_json(result.warnings);
  json["sources"] = sources_json(result);
  json["curves"] = curves_json(result.found.curves);
  json["search"] = search_json(result.found.report);
  Json& mesh = json["mesh"] = mesh_json(result.elements);
  mesh.update(along_curves_json(result.mesh));
  mesh["area_quality"] = area_quality_json(result.elements);
  mesh["irradiance_tolerance_w_per_m2"] = result.irradiance_tolerance;
  json["stages"] = stages_json(result.stages);
  json["outputs"] = to_json(run.outputs);
  write(json, path);
}

void write_report(const ProbeReport& report, const RunInfo& run,
                  const std::filesystem::path& path) {
  Json json = head_json(run);
  json["points"] = report.points;
  json["points_done"] = report.points_done;
  json["direct_only"] = report.direct_only;
  json["interrupted"] = report.points_done < report.points;
  json["outputs"] = to_json(run.outputs);
  write(json, path);
}

void write_report(const StudyReport& report, const RunInfo& run,
                  const std::filesystem::path& path) {
  Json json = head_json(run);
  json["cases"] = report.cases;
  json["interrupted"] = !report.complete;
  json["outputs"] = to_json(run.outputs);
  write(json, path);
}

namespace {

Json false_colours_json(const RenderReport& report) {
  Json json = {{"name", report.quantity.name},
               {"channel", report.quantity.channel},
               {"unit", report.quantity.unit},
               {"range", {report.range.low, report.range.high}}};
  if (report.difference)
    json["difference"] = {{"rms", report.difference->rms},
                          {"mean", report.difference->mean},
                          {"largest", report.difference->largest},
                          {"relative_rms", report.difference->relative}};
  return json;
}

}  // namespace

void write_report(const RenderReport& report, const RunInfo& run,
                  const std::filesystem::path& path) {
  Json json = head_json(run);
  json["width"] = report.width;
  json["height"] = report.height;
  if (report.exposure > 0) json["exposure"] = report.exposure;
  if (report.samples > 0) {
    json["samples"] = report.samples;
    json["relative_standard_error"] = report.standard_error;
  }
  if (!report.quantity.name.empty()) json["quantity"] = false_colours_json(report);
  json["camera"] = {{"name", report.camera.name},
                    {"position", to_json(report.camera.position)},
                    {"direction", to_json(report.camera.direction)},
                    {"up", to_json(report.camera.up)},
                    {"vertical_fov_degrees", report.camera.vertical_fov}};
  json["outputs"] = to_json(run.outputs);
  write(json, path);
}

}  // namespace halfshade
