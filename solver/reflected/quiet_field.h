#pragma once

#include "solver/reflected/field_noise.h"
#include "solver/reflected/reflected_mesh.h"

#include <vector>

namespace halfshade {

/// A field that rays have found, and its noise, on all triangles of the forest: what is smooth over
/// many leaves is known by the rays of all of them.
struct NoisyForest {
  ElementField field;  ///< triangle → projection of what its leaves carry, of their highest order
  FieldNoise noise;    ///< of it
  /// Triangle that is split → ∫ of the square of what its halves add to it.
  std::vector<double> added;
};
NoisyForest noisy_forest(const ReflectedMesh& mesh, const ElementField& field,
                         const FieldNoise& noise);

/// A field with less noise, and what is left of that.
struct QuietField {
  ElementField field;
  std::vector<double> noise;  ///< element → ∫ over it of its square, weighted
};

/// What a pair of halves adds to the polynomial of their whole, and of roots the polynomials of
/// each degree but 0, as small as they are expected to be without the noise (Wiener's filter): what
/// is mostly noise goes, what is not stays. Means over roots stay.
QuietField without_noise(const ReflectedMesh& mesh, const NoisyForest& noisy,
                         const std::vector<double>& weight);

/// How many times as many rays from everywhere would leave no more noise than `wanted`, over all
/// elements, weighted; at most some 10,000.
double rays_for(const ReflectedMesh& mesh, const NoisyForest& noisy,
                const std::vector<double>& weight, double wanted);

}  // namespace halfshade
