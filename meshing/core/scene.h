#pragma once

#include "meshing/core/texture.h"
#include "meshing/core/types.h"

#include <string>
#include <vector>

namespace halfshade {

/// A diffuse surface material.
struct Material {
  std::string name;
  Rgb rho = Rgb::Constant(0.5);  ///< reflectance, 0 ≤ rho ≤ 1 per channel
  Rgb exitance = Rgb::Zero();    ///< emitted radiosity E in W/m², ≥ 0
  bool two_sided = false;        ///< exchanges light on its back side, too
};

/// A polygon with n ≥ 3 vertices; its front is where they run counter-clockwise. It is opaque on
/// both sides and exchanges light on the front only, unless its material is two-sided.
struct Face {
  std::vector<int> vertices;  ///< into Scene::vertices
  int material = 0;           ///< into Scene::materials
  int group = 0;              ///< into Scene::groups
  int line = 0;               ///< where the file has it; 0 where the format has no lines
  int paint = -1;             ///< into Scene::paints: multiplies the reflectance; −1: none
};

/// A perspective camera.
struct Camera {
  std::string name = "camera";
  Vec3 position = Vec3::Zero();
  Vec3 direction = -Vec3::UnitZ();  ///< need not be of unit length
  Vec3 up = Vec3::UnitY();          ///< not parallel to the direction
  double vertical_fov = 40;         ///< degrees, in (0, 180)
};

/// What the user gave: plain data, as the file has it.
struct Scene {
  std::string source;      ///< the file's name, for messages
  std::string unit = "m";  ///< of all lengths
  std::vector<Vec3> vertices;
  std::vector<Face> faces;
  std::vector<Material> materials;
  std::vector<Paint> paints;
  std::vector<std::string> groups;
  std::vector<Camera> cameras;
};

/// "face 7 (line 31)": how messages name a face. Faces count from 1, like lines; a line of 0 is
/// left out.
std::string face_label(int face, int line);
std::string face_label(const Scene& scene, int face);

/// The corners of a face, in order. `face` must be valid.
std::vector<Vec3> face_corners(const Scene& scene, int face);

/// Diagonal of the bounding box of all faces, scene units. The faces must be valid.
double diagonal(const Scene& scene);

/// Checks that everything the rest of halfshade relies on holds: indices in range, ≥ 3 vertices per
/// face, finite coordinates whose size and spread double precision can carry, 0 ≤ rho ≤ 1,
/// finite exitance ≥ 0, finite paints, at least one face, usable cameras. Throws
/// Error(invalid_input) with the file and face of the first violation.
void validate(const Scene& scene);

/// Throws Error(invalid_input) unless some face emits light.
void require_emitter(const Scene& scene);

}  // namespace halfshade
