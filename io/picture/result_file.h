#pragma once

#include "io/picture/picture.h"
#include "solver/pipeline/saved_light.h"

#include <filesystem>
#include <string>
#include <vector>

namespace halfshade {

/// Numbers of a result, one row a point or a cell.
struct ResultArray {
  std::string name;
  int components = 1;
  bool is_whole = false;  ///< codes and counts
  std::vector<double> values;
};

/// What a .vtu or .vtp of `solve` or `mesh` holds.
struct ResultFile {
  std::filesystem::path path;
  std::vector<Vec3> points;             ///< finite
  std::vector<std::vector<int>> cells;  ///< nodes of each triangle, see element_nodes
  std::vector<int> order;               ///< of each cell, ≥ 1
  std::vector<ResultArray> point_arrays, cell_arrays;
  std::vector<Camera> cameras;
  std::vector<Paint> paints;    ///< that the array `paint` of the cells names
  std::vector<Rgb> paint_most;  ///< reflectance where the picture is white
  bool interrupted = false;     ///< the light is not complete
  int bounces = -1;             ///< light after at most so many reflections; −1: all
  double achieved_error = 0;    ///< relative; 0: not known
  double lamp_tolerance = 0;    ///< that lamps with pictures were cut for; 0: there are none
};

/// Throws Error(invalid_input) for anything that halfshade has not written, whatever is in the
/// file.
ResultFile read_result(const std::filesystem::path& path);

/// Its light, ready to be drawn. Throws Error(invalid_input) if it has none, as the files of
/// `mesh`, or if numbers are not finite.
ShadedMesh shaded(const ResultFile& file);

/// Its irradiance on its cells. Throws Error(invalid_input) if it has none, or if numbers are not
/// finite.
SavedLight saved_light(const ResultFile& file);

/// One number of a result.
struct Quantity {
  std::string name;     ///< of the array
  std::string channel;  ///< what of its components, "R" or "mean of R, G, B"; empty if it has one
  std::string unit;     ///< "W/m²"; empty: none
  bool is_whole = false;
};

/// A mesh that carries it in all three channels.
struct ValueMesh {
  ShadedMesh mesh;
  Quantity quantity;
};

/// An array of a result as something to draw: at points if the file has it there, else one value a
/// cell. `channel`: "mean" of the components, R, G or B, or the component's number from 0. Throws
/// Error(usage), naming those there are, for an unknown name or channel, also for the mean of
/// codes, and Error(invalid_input) if numbers are not finite.
ValueMesh quantity_of(const ResultFile& file, const std::string& name,
                      const std::string& channel = "mean");

}  // namespace halfshade
