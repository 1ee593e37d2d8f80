#include "io/files/cameras_json.h"

#include <nlohmann/json.hpp>

#include <array>

namespace halfshade::detail {
namespace {

nlohmann::json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Vec3 to_vec3(const nlohmann::json& json) {
  const auto v = json.get<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}

}  // namespace

std::string cameras_to_json(const std::vector<Camera>& cameras) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Camera& camera : cameras)
    json.push_back({{"name", camera.name},
                    {"position", to_json(camera.position)},
                    {"direction", to_json(camera.direction)},
                    {"up", to_json(camera.up)},
                    {"vertical_fov", camera.vertical_fov}});
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::vector<Camera> cameras_from_json(const std::string& text) {
  std::vector<Camera> cameras;
  for (const nlohmann::json& json : nlohmann::json::parse(text)) {
    Camera camera;
    camera.name = json.at("name").get<std::string>();
    camera.position = to_vec3(json.at("position"));
    camera.direction = to_vec3(json.at("direction"));
    camera.up = to_vec3(json.at("up"));
    camera.vertical_fov = json.at("vertical_fov").get<double>();
    cameras.push_back(camera);
  }
  return cameras;
}

}  // namespace halfshade::detail
