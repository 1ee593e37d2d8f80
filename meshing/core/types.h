#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>

/// The vocabulary of every other header. Lengths are in scene units unless a comment says
/// otherwise.
namespace halfshade {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// Three channels: red, green, blue, or any three wavelength bands.
using Rgb = Eigen::Array3d;

/// An id as an index of an array. Ids are ints, ≥ 0 where they are used as such.
inline std::size_t at(int id) { return static_cast<std::size_t>(id); }

}  // namespace halfshade
