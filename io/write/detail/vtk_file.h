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
/// Rows of three components, named R, G and B.
void add_colours(vtkFieldData* data, const char* name, const std::vector<double>& values);
void add_channels(vtkFieldData* data, const char* name, const ChannelArray& values);

/// 0 lit, 1 penumbra, 2 umbra, 3 where no emitter lies above the horizon.
std::vector<int> region_codes(const std::vector<Region>& regions);

/// Cell data face, group, material, surface, level and quality.
void add_element_data(const ElementTable& elements, vtkFieldData* data);

/// Cell data edge_order, three components: see ElementTable. Nothing where elements have none.
void add_edge_orders(const ElementTable& elements, vtkFieldData* data);

/// Points and triangles, without data: an unstructured grid for ".vtu", poly data for ".vtp".
vtkSmartPointer<vtkPointSet> element_grid(const ElementTable& elements, std::string_view extension);

/// Elements of order ≥ 1, each with nodes of its own, one element's after the other's: triangles of
/// VTK's that are straight, quadratic or Lagrange's.
vtkSmartPointer<vtkPointSet> polynomial_grid(std::span<const Vec3> nodes,
                                             std::span<const int> order);

/// Field data interrupted (0 or 1): what every file says. Field data hold numbers only, since some
/// readers fail on strings, and nothing that differs from run to run.
void add_interrupted(vtkFieldData* data, bool interrupted);

/// Field data cameras and camera_names, see CameraNumbers.
void add_cameras(vtkFieldData* data, const std::vector<Camera>& cameras);

/// Field data sources (surfaces' ids) and source_exitance (W/m²): the components of regions.
void add_sources(vtkFieldData* data, const std::vector<LightSource>& sources);

/// Replaces the points of a grid, in double precision.
void set_points(vtkPointSet* grid, std::span<const Vec3> points);

/// The file's bytes: .vtu for an unstructured grid, .vtp for poly data; XML with inline, compressed
/// binary data, sealed. Throws Error(unwritable) in the name of `caller`.
std::string vtk_bytes(vtkPointSet* grid, const char* caller);

}  // namespace halfshade::detail
