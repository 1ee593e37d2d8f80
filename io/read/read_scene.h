#pragma once

#include "meshing/core/scene.h"
#include "solver/heat/heat.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace halfshade {

/// Of the irradiance: what lamps with pictures are cut for if nothing else is said.
inline constexpr double usual_lamp_tolerance = 0.01;

/// What lamps with pictures are cut for.
struct LampOptions {
  double tolerance = usual_lamp_tolerance;  ///< of the irradiance, as for solve; > 0
  /// The scene as its faces are turned later on, one by one; none: they stay.
  std::function<Scene(const Scene&)> turned;
};

/// How lamps with pictures were cut into pieces that shine evenly.
struct LampPictures {
  double tolerance = 0;  ///< that they were cut for; 0: there are none
  /// What irradiance is off, L2 norm over all surfaces and channels, and that relative to direct
  /// light's; estimated, as if nothing were in shadow.
  double error = 0, relative_error = 0;
  bool is_limited = false;  ///< that is too much, but there are as many pieces as there may be
  std::string limit;        ///< what the warning says of that, else empty
};

/// A scene as read, and what of the file was not used.
struct SceneFile {
  Scene scene;
  std::vector<std::string> warnings;  ///< one sentence each, with file and line where known
  std::vector<std::string> guesses;   ///< what is taken where the files say nothing, likewise
  std::vector<std::filesystem::path>
      files;                              ///< read besides the scene: material libraries, buffers
  std::vector<std::string> empty_groups;  ///< that the file names without giving them faces
  Heat heat;                              ///< what is said of temperatures, bands and net fluxes
  LampPictures lamps;
};

/// Reads a scene by its extension: .obj (+ .mtl), .ply, .off, .vs3, .msh and .stl as text in double
/// precision, .msh binary too, .stl binary in its single one; .gltf, .glb, .dae and .3ds through
/// assimp in single precision. Polygons stay polygons. Applies the sidecar (the scene's path with
/// .json as extension, if there is one) and then the materials file `materials` (none if empty),
/// and validates the result.
///
/// OBJ: `Kd` is the reflectance, `Ke` the exitance in W/m²; `g` and `o` start groups; faces before
/// any usemtl, and formats without materials, get a material named "default". glTF and COLLADA:
/// groups are nodes, base or diffuse colour is the reflectance, emission the exitance. View3D
/// (.vs3): surfaces are groups by their names, those that are combined one group; the reflectance
/// is 1 − emissivity; obstructions are black. Gmsh (.msh): physical surfaces are groups. Materials
/// that no face uses are left out; a material that only a usemtl names must be given by a materials
/// file. Names in a materials file are groups' or else materials'; a group's entry wins on its
/// faces, which get a material of their own.
///
/// Heat: `emissivity` (1 − reflectance), `temperature` (K, for the exitance) and `net_flux` (0: the
/// reflectance is 1, the temperature is found) of .mtl and materials files become reflectances and
/// exitances. `bands` in a materials file name channels, with or without wavelengths_um; more than
/// three are in the heat alone, and the scene has what they come to.
///
/// Lamps with pictures become lamps that shine evenly, as many as their tolerance takes.
///
/// Throws Error(usage) for an unknown extension and Error(invalid_input) with file, line or face
/// for anything that is not a sound scene.
SceneFile read_scene(const std::filesystem::path& path, const std::filesystem::path& materials = {},
                     const LampOptions& lamps = {});

}  // namespace halfshade
