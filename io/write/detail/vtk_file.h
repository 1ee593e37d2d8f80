#pragma once

#include "io/write/write_result.h"

#include <vtkSmartPointer.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

class vtkFieldData;
class vtkPointSet;

/// What all files that VTK writes have in common.
namespace halfshade::detail {

/// Arrays of rows of `components` numbers.
void add_numbers(vtkFieldData* data, const char* name, const std::vector<double>& values,
                 int components = 1);
void add_integers(vtkFieldData* data, const char* name, const std::vector<int>& values,
                  int components = 1);
void add_channels(vtkFieldData* data, const char* name, const ChannelArray& values);
void add_strings(vtkFieldData* data, const char* name, const std::vector<std::string>& values);

/// 0 lit, 1 penumbra, 2 umbra, 3 where no emitter lies above the horizon.
std::vector<int> region_codes(const std::vector<Region>& regions);

/// Cell data face, group, material, surface, level and quality.
void add_element_data(const ElementTable& elements, vtkFieldData* data);

/// Points and triangles, without data: an unstructured grid for ".vtu", poly data for ".vtp".
vtkSmartPointer<vtkPointSet> element_grid(const ElementTable& elements, std::string_view extension);

/// What every run leaves in the field data.
struct RunData {
  const SoundScene& scene;
  const std::vector<Camera>& cameras;
  const std::string& unit;
  const std::vector<StageReport>& stages;
  bool interrupted;
};
void add_run(vtkFieldData* data, const RunData& run, const Provenance& provenance);

/// Field data version and command_line.
void add_provenance(vtkFieldData* data, const Provenance& provenance);

/// Replaces the points of a grid, in double precision.
void set_points(vtkPointSet* grid, std::span<const Vec3> points);

/// The file's bytes: .vtu for an unstructured grid, .vtp for poly data; XML with inline, compressed
/// binary data, sealed. Throws Error(unwritable) in the name of `caller`.
std::string vtk_bytes(vtkPointSet* grid, const char* caller);

}  // namespace halfshade::detail
