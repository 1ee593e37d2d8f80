#include "io/picture/painted_points.h"

namespace halfshade::detail {

void separate_painted(const std::vector<Rgb>& irradiance, const std::vector<Rgb>& reflectance,
                      ShadedMesh& mesh) {
  for (std::size_t t = 0; t < mesh.painted.size(); ++t) {
    if (mesh.painted[t].paint < 0) continue;
    for (int& corner : mesh.triangles[t]) {
      const Vec3 point = mesh.points[at(corner)];
      mesh.points.push_back(point);
      mesh.point_value.emplace_back(irradiance[at(corner)] * reflectance[t]);
      corner = static_cast<int>(mesh.points.size()) - 1;
    }
  }
}

}  // namespace halfshade::detail
