#pragma once

#include "tests/support/scenes.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

/// Scenes with pictures on them.
namespace halfshade::test {

/// What a byte of an sRGB picture stands for, from 0 to 1.
inline double linear(int byte) {
  const double v = byte / 255.;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// A picture that is one colour left of its middle, another right of it.
inline std::shared_ptr<const Texture> two_coloured(const Rgb& left, const Rgb& right,
                                                   int width = 1024) {
  std::vector<Eigen::Array3f> texels;
  for (int k = 0; k < width; ++k) texels.emplace_back((2 * k < width ? left : right).cast<float>());
  return std::make_shared<const Texture>(make_texture("two", width, 1, std::move(texels)));
}

/// Over the plane from x = 0 to `width`.
inline Paint across_x(std::shared_ptr<const Texture> texture, double width) {
  Paint paint;
  paint.texture = std::move(texture);
  paint.along(0, 0) = 1 / width;
  return paint;
}

/// A closed room of 2 × 1 × 1 with a lamp in its ceiling. The wall y = 1 is red left and blue right
/// of its middle: a picture on one face, or two faces.
inline Scene two_coloured_room(bool as_picture) {
  const Rgb red(0.8, 0.2, 0.1), blue(0.1, 0.3, 0.7);
  Scene scene;
  const int grey = add_material(scene, 0.6, 0), lamp = add_material(scene, 0, 10);
  const auto faces = box_faces(Vec3::Zero(), {2, 1, 1}, true);
  for (const std::size_t f : {0U, 1U, 2U, 4U, 5U}) add_polygon(scene, faces[f], grey);
  add_polygon(scene, {{0.6, 0.3, 0.95}, {0.6, 0.7, 0.95}, {1.2, 0.7, 0.95}, {1.2, 0.3, 0.95}},
              lamp);
  const auto wall = [&](double from, double to, const Rgb& rho) {
    const int material = add_material(scene, 1, 0);
    scene.materials.back().rho = rho;
    add_polygon(scene, {{from, 1, 0}, {from, 1, 1}, {to, 1, 1}, {to, 1, 0}}, material);
    std::swap(scene.faces.back().vertices[1], scene.faces.back().vertices[3]);
  };
  if (as_picture) {
    wall(0, 2, Rgb::Ones());
    scene.paints.push_back(across_x(two_coloured(red, blue), 2));
    scene.faces.back().paint = 0;
  } else {
    wall(0, 1, red);
    wall(1, 2, blue);
  }
  return scene;
}

}  // namespace halfshade::test
