#include "solver/reflected/first_light.h"

#include <utility>

namespace halfshade {

ChannelArray FirstLight::reflected(const ReflectedMesh& mesh, int element,
                                   const ChannelArray& f) const {
  const int root = mesh.root(element);
  if (!painted.is_painted(root)) return f.rowwise() * rho[at(root)].transpose();
  const PaintedProduct& product = painted.product(mesh, element);
  ChannelArray result(f.rows(), 3);
  for (int c = 0; c < 3; ++c) result.col(c) = product[at(c)] * f.col(c).matrix();
  return result;
}

Rgb FirstLight::absorbed(const ReflectedMesh& mesh, int element, const ChannelArray& f) const {
  const int root = mesh.root(element);
  const Rgb mean = f.row(0).transpose();
  if (!painted.is_painted(root)) return (1 - rho[at(root)]) * mean;
  return mean - reflected(mesh, element, f).row(0).transpose();
}

Rgb FirstLight::mean_rho(const ReflectedMesh& mesh, int element) const {
  const int root = mesh.root(element);
  if (!painted.is_painted(root)) return rho[at(root)];
  const PaintedProduct& product = painted.product(mesh, element);
  return {product[0](0, 0), product[1](0, 0), product[2](0, 0)};
}

FirstLight first_light(const SoundScene& scene, const ElementTable& roots, DirectIrradiance direct,
                       bool through_operator) {
  FirstLight light;
  light.surface = roots.surface;
  for (const int m : roots.material) {
    light.rho.push_back(scene.materials[at(m)].rho);
    light.exitance.push_back(scene.materials[at(m)].exitance);
  }
  std::vector<int> paint;
  for (const int s : roots.surface) paint.push_back(scene.surfaces[at(s)].paint);
  light.painted = PaintedElements(std::move(paint), scene.paints);
  light.direct = std::move(direct);
  light.through_operator = through_operator;
  return light;
}

}  // namespace halfshade
