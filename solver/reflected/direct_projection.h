#pragma once

#include "solver/reflected/first_light.h"
#include "solver/reflected/reflected_mesh.h"

#include <memory>
#include <vector>

namespace halfshade {

/// Direct light as polynomials on the elements: what power is put into systems, and what rows that
/// are not made of rays take S from. Kept for elements that do not change.
class DirectProjection {
 public:
  /// Direct light is asked for at about this number of points over all surfaces, and at the nodes.
  explicit DirectProjection(int points) : points_(points) {}

  /// Asks for the light on new elements, of painted ones for what leaves them, too.
  void update(const ReflectedMesh& mesh, const FirstLight& light);

  /// Its mean over an element.
  Rgb mean(const ReflectedMesh& mesh, int element) const {
    return of_triangle_[at(mesh.triangle[at(element)])]->row(0).transpose();
  }

  /// Mean of ρ H_d over an element.
  Rgb mean_leaving(const ReflectedMesh& mesh, const FirstLight& light, int element) const;

  /// S.
  ElementField leaving(const ReflectedMesh& mesh, const FirstLight& light) const;

 private:
  int points_;
  std::vector<std::unique_ptr<ChannelArray>> of_triangle_;  ///< coefficients
  /// Of what leaves painted elements; null for others.
  std::vector<std::unique_ptr<ChannelArray>> painted_;
};

}  // namespace halfshade
