#pragma once

#include "meshing/patches/element_table.h"
#include "solver/elements/solution.h"

namespace halfshade {

/// How far constant elements are from the irradiance they stand for: the distance, in the L2 mean
/// over each element and over the channels, between the element's value and the linear function
/// through the averaged values at its corners (recovery in the manner of Zienkiewicz and Zhu 1987).
/// In W/m², one entry an element. An estimate of the mesh's error, asymptotically exact where the
/// irradiance is smooth; it does not know of errors in the form factors, nor of shadows narrower
/// than an element.
Eigen::ArrayXd recovery_estimate(const ElementTable& elements, const ChannelArray& irradiance);

/// The estimate of all elements together, relative to the L2 norm of the irradiance; 0 in the dark.
double relative_error(const ElementTable& elements, const ChannelArray& irradiance,
                      const Eigen::ArrayXd& estimate);

}  // namespace halfshade
