#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/elements/element_field.h"

#include <array>

namespace halfshade {

/// What a painted triangle does to light that arrives as a polynomial: for each channel the matrix
/// that takes the coefficients of f to those of the projection of ρ f. The first entry is the mean
/// reflectance.
using PaintedProduct = std::array<Eigen::MatrixXd, 3>;

/// By values at the middles of equal parts, a few for each texel, of a smaller copy of the picture
/// if that takes many: exact to about 1e-3 of the variation within the triangle. `rho` is the
/// material's reflectance. Throws Error(contract) as basis_at.
PaintedProduct painted_product(const Paint& paint, const Rgb& rho,
                               const std::array<Vec3, 3>& triangle, int order);

/// Mean of a picture over a triangle.
Rgb mean_colour(const Paint& paint, const std::array<Vec3, 3>& triangle);

/// Mean reflectance of a triangle of a surface.
Rgb mean_reflectance(const SoundScene& scene, const Surface& surface,
                     const std::array<Vec3, 3>& triangle);

/// Mean of ρ f over an element, which lies in `surface`.
Rgb mean_reflected(const SoundScene& scene, const Surface& surface, const ElementTable& elements,
                   const ElementField& field, int element);

}  // namespace halfshade
