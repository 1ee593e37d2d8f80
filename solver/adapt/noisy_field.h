#pragma once

#include "solver/adapt/adaptive_field.h"
#include "solver/elements/noisy_value.h"

namespace halfshade {

/// A field on surfaces that is known but for noise, W/m²: its values at points, and how many times
/// as much noise as usual each of them may have, ≥ 1. It must be the same for the same points.
using NoisyFieldAt = std::function<std::vector<NoisyValue>(
    std::span<const FieldPoint>, std::span<const double> slack, const Progress&)>;

/// W/m² that a field at a point does not exceed, roughly.
using FieldBound = std::function<double(const FieldPoint&)>;

/// The same as fit_adaptively for a field that is known but for noise, on so many elements that
/// samples are dear: orders 0 to 2 by least squares through samples at places that are as good as
/// random, which stay with the parts when an element is bisected. Elements begin with as many as
/// `bound` says that they matter, and may be noisier where they are small: most of very many are,
/// and what they are off hardly counts. Their parts may be no noisier than they: those gather where
/// light is. All may be where light is uneven, once that is known, of very many elements from a few
/// places beforehand: usual noise suits a tolerance of the mean. And all may be where the first
/// samples have less of it than the tolerance lets them: most rays tell the same.
///
/// What an element may be off follows from what is left at its samples, less the noise, and from
/// how many they are. Before it is believed, samples at new places are compared: the product of
/// what two values are off, each with noise of its own, is the square of the error in the mean. The
/// error reported is the larger one, with two standard deviations of it.
///
/// Of the options `order`, `weight`, `merge` and `samples_of_other_way` do not count. If stopped,
/// the elements keep what the last whole round gave. The same for any number of threads.
AdaptiveField fit_noisy(PatchMesh& mesh, const NoisyFieldAt& field, const FieldBound& bound,
                        const AdaptiveFieldOptions& options, const Progress& progress = {});

}  // namespace halfshade
