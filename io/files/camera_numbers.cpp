#include "io/files/camera_numbers.h"

namespace halfshade::detail {

CameraNumbers to_numbers(const std::vector<Camera>& cameras) {
  CameraNumbers result;
  for (const Camera& camera : cameras) {
    for (const Vec3& v : {camera.position, camera.direction, camera.up})
      result.values.insert(result.values.end(), v.begin(), v.end());
    result.values.push_back(camera.vertical_fov);
    for (const char c : camera.name)
      if (c != '\0') result.names.push_back(static_cast<unsigned char>(c));
    result.names.push_back(0);
  }
  return result;
}

std::vector<Camera> to_cameras(const CameraNumbers& numbers) {
  std::vector<Camera> cameras(numbers.values.size() / camera_components);
  std::size_t next = 0;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    const double* v = numbers.values.data() + k * camera_components;
    Camera& camera = cameras[k];
    camera.position = {v[0], v[1], v[2]};
    camera.direction = {v[3], v[4], v[5]};
    camera.up = {v[6], v[7], v[8]};
    camera.vertical_fov = v[9];
    camera.name.clear();
    while (next < numbers.names.size() && numbers.names[next] != 0)
      camera.name += static_cast<char>(numbers.names[next++]);
    ++next;
  }
  return cameras;
}

}  // namespace halfshade::detail
