#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// The vocabulary of every other header. Lengths are in scene units unless a comment says
/// otherwise.
namespace halfshade {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// Three channels: red, green, blue, or any three wavelength bands.
using Rgb = Eigen::Array3d;

}  // namespace halfshade
