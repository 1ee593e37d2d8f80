#pragma once

#include "meshing/core/scene.h"
#include "meshing/core/sound_scene.h"

#include <compare>
#include <string>
#include <vector>

namespace halfshade {

/// What a row of a form-factor matrix stands for.
enum class FactorUnit { face, group, material };

/// What surfaces that have no row belong to.
inline constexpr int surroundings = -1;  ///< all that lies round the scene
inline constexpr int unused_back = -2;   ///< of a face that exchanges light on its front only

/// The face, group or material that a row stands for, and which side of it.
struct FactorRow {
  int id = 0;  ///< counts from 0
  bool is_back = false;

  auto operator<=>(const FactorRow&) const = default;
};

/// A scene made sound for form factors. Round it stands a box that looks inwards, so that what
/// leaves the scene arrives somewhere, too, and backs that exchange no light are surfaces of their
/// own, so that what they swallow is known.
struct FactorScene {
  SoundScene sound;
  std::string unit;                ///< of lengths
  std::vector<int> row;            ///< surface → row, `surroundings` or `unused_back`
  std::vector<std::string> names;  ///< of the rows: "face 7", a group or a material; backs of
                                   ///< two-sided ones have " back" after it
  std::vector<double> areas;       ///< of the rows, squared scene units
  std::vector<FactorRow> keys;     ///< of the rows, rising

  int rows() const { return static_cast<int>(names.size()); }
};

/// Rows are in the order of faces, groups or materials, each with its back after it; what the
/// repair leaves no area of has none. With FactorUnit::face, coplanar neighbours stay apart.
/// Throws as validate() and make_sound() do. No emitter is needed.
FactorScene make_factor_scene(const Scene& scene, FactorUnit unit);

/// "face 7", or the name of a group or material; with " back" for a back.
std::string row_name(const Scene& scene, FactorUnit unit, const FactorRow& row);

}  // namespace halfshade
