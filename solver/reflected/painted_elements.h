#pragma once

#include "solver/elements/painted_triangle.h"
#include "solver/reflected/reflected_mesh.h"

#include <memory>
#include <vector>

namespace halfshade {

/// What the elements of painted roots reflect of polynomials on them. Kept for elements that do not
/// change.
class PaintedElements {
 public:
  PaintedElements() = default;
  /// `paint`, one entry a root, into `paints`; −1: none.
  PaintedElements(std::vector<int> paint, std::vector<Paint> paints);

  bool is_painted(int root) const { return !paint_.empty() && paint_[at(root)] >= 0; }

  /// 1 where nothing is painted.
  Rgb colour_at(int root, const Vec3& position) const {
    return is_painted(root) ? halfshade::colour_at(paints_[at(paint_[at(root)])], position)
                            : Rgb(Rgb::Ones());
  }

  /// Makes what is missing for a mesh, with the reflectance of each root's material. Only for
  /// meshes of the same forest, as it grows.
  void update(const ReflectedMesh& mesh, const std::vector<Rgb>& rho);

  /// Of an element of a painted root, as last updated.
  const PaintedProduct& product(const ReflectedMesh& mesh, int element) const {
    return *of_triangle_[at(mesh.triangle[at(element)])];
  }

 private:
  std::vector<int> paint_;  ///< empty: nothing is painted
  std::vector<Paint> paints_;
  std::vector<std::shared_ptr<const PaintedProduct>> of_triangle_;
};

}  // namespace halfshade
