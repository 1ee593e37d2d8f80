#pragma once

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <filesystem>
#include <string>
#include <vector>

/// Reads files back with VTK's own readers.
namespace halfshade::test {

template <class Reader>
vtkSmartPointer<vtkPointSet> read_vtk_with(const std::filesystem::path& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

inline vtkSmartPointer<vtkPointSet> read_vtk(const std::filesystem::path& path) {
  return path.extension() == ".vtu" ? read_vtk_with<vtkXMLUnstructuredGridReader>(path)
                                    : read_vtk_with<vtkXMLPolyDataReader>(path);
}

/// Every component of every row; a failure and nothing if there is no such array.
inline std::vector<double> numbers(vtkFieldData* data, const char* name, int components = 1) {
  vtkDataArray* array = data->GetArray(name);
  if (array == nullptr || array->GetNumberOfComponents() != components) {
    ADD_FAILURE() << "no array '" << name << "' of " << components << " components";
    return {};
  }
  std::vector<double> values;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    for (int c = 0; c < components; ++c) values.push_back(array->GetComponent(i, c));
  return values;
}

}  // namespace halfshade::test
