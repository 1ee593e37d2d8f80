#pragma once

#include "meshing/core/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace halfshade::test {

/// A scene of squares and boxes as the text of an OBJ file and its materials.
class SceneText {
 public:
  SceneText() {
    reflectance("dark", 0, 0);
    reflectance("light", 0, 1);
  }

  SceneText& polygon(const std::string& material, const std::string& group,
                     const std::vector<Vec3>& corners) {
    polygons_.push_back({material, group, corners});
    return *this;
  }
  /// A horizontal square round the z axis that looks up.
  SceneText& square(const std::string& material, const std::string& group, double half, double z) {
    return polygon(material, group,
                   {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
  }
  SceneText& floor(double half) { return square("dark", "floor", half, 0); }
  SceneText& table(double half, double z) { return square("dark", "table", half, z); }
  /// Looks down.
  SceneText& lamp(double half, double z) {
    return polygon("light", "lamp",
                   {{-half, half, z}, {half, half, z}, {half, -half, z}, {-half, -half, z}});
  }
  /// The six walls of a cube; they look inwards if `size` is positive, else outwards.
  SceneText& room(const std::string& material, const std::string& group, const Vec3& low,
                  double size) {
    const double s = std::abs(size);
    const auto p = [&](int x, int y, int z) -> Vec3 { return low + s * Vec3(x, y, z); };
    for (std::vector<Vec3> wall : {std::vector{p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0)},
                                   std::vector{p(0, 1, 1), p(1, 1, 1), p(1, 0, 1), p(0, 0, 1)},
                                   std::vector{p(0, 0, 0), p(0, 0, 1), p(1, 0, 1), p(1, 0, 0)},
                                   std::vector{p(1, 1, 0), p(1, 1, 1), p(0, 1, 1), p(0, 1, 0)},
                                   std::vector{p(0, 1, 0), p(0, 1, 1), p(0, 0, 1), p(0, 0, 0)},
                                   std::vector{p(1, 0, 0), p(1, 0, 1), p(1, 1, 1), p(1, 1, 0)}}) {
      if (size < 0) std::reverse(wall.begin(), wall.end());
      polygon(material, group, wall);
    }
    return *this;
  }
  SceneText& reflectance(const std::string& material, double rho, double exitance) {
    materials_[material] = {rho, exitance};
    return *this;
  }
  /// Of the lamps.
  SceneText& exitance(double exitance) { return reflectance("light", 0, exitance); }
  SceneText& move(const Vec3& by) {
    for (Polygon& polygon : polygons_)
      for (Vec3& p : polygon.corners) p += by;
    return *this;
  }
  SceneText& scale(double factor) {
    for (Polygon& polygon : polygons_)
      for (Vec3& p : polygon.corners) p *= factor;
    return *this;
  }

  std::string obj() const {
    std::string text;
    int count = 0;
    for (const Polygon& polygon : polygons_) {
      std::string face = "f";
      for (const Vec3& p : polygon.corners) {
        text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x(), p.y(), p.z());
        face += fmt::format(" {}", ++count);
      }
      text += fmt::format("g {}\nusemtl {}\n{}\n", polygon.group, polygon.material, face);
    }
    return text;
  }
  std::string mtl() const {
    std::string text;
    for (const auto& [name, values] : materials_)
      text +=
          fmt::format("newmtl {0}\nKd {1:.17g} {1:.17g} {1:.17g}\nKe {2:.17g} {2:.17g} {2:.17g}\n",
                      name, values.rho, values.exitance);
    return text;
  }

 private:
  struct Polygon {
    std::string material, group;
    std::vector<Vec3> corners;
  };
  struct Values {
    double rho = 0, exitance = 0;
  };
  std::vector<Polygon> polygons_;
  std::map<std::string, Values> materials_;
};

}  // namespace halfshade::test
