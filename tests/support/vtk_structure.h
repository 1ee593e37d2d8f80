#pragma once

#include "tests/support/files.h"
#include "tests/support/vtk_reading.h"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkPointData.h>

#include <set>
#include <string>

/// What programs other than ours ask of a VTK file.
namespace halfshade::test {

/// Tags named DataArray or Array, one string each.
inline std::vector<std::string> array_tags(const std::string& xml) {
  std::vector<std::string> tags;
  for (std::size_t at = xml.find("Array "); at != std::string::npos;
       at = xml.find("Array ", at + 1))
    tags.push_back(xml.substr(at, xml.find('>', at) - at));
  return tags;
}

/// type="Float64" and the like: numbers of a size that every reader knows.
inline bool has_numbers(const std::string& tag) {
  for (const char* kind : {"Float", "Int", "UInt"})
    for (const char* bits : {"8", "32", "64"})
      if (tag.find(std::string("type=\"") + kind + bits + '"') != std::string::npos) return true;
  return false;
}

inline void expect_colours_are_named(vtkFieldData* data) {
  static const std::set<std::string> colours = {"radiosity", "irradiance", "direct_irradiance",
                                                "exitance", "reflectance"};
  for (int k = 0; k < data->GetNumberOfArrays(); ++k) {
    vtkAbstractArray* array = data->GetAbstractArray(k);
    if (!colours.contains(array->GetName())) continue;
    ASSERT_EQ(array->GetNumberOfComponents(), 3) << array->GetName();
    for (int c = 0; c < 3; ++c) {
      ASSERT_NE(array->GetComponentName(c), nullptr) << array->GetName();
      EXPECT_EQ(std::string(array->GetComponentName(c)), std::string(1, "RGB"[c]));
    }
  }
}

/// Numbers only, inline, one entry a point or a cell, corners that exist, named colours.
inline void expect_sound_vtk(const std::filesystem::path& path) {
  const std::string xml = contents(path);
  for (const std::string& tag : array_tags(xml)) {
    EXPECT_EQ(tag.find("String"), std::string::npos) << path << ": " << tag;
    EXPECT_NE(tag.find("format=\"binary\""), std::string::npos) << path << ": " << tag;
    EXPECT_TRUE(has_numbers(tag)) << tag;
  }
  EXPECT_GT(array_tags(xml).size(), 3U) << path;
  const auto grid = read_vtk(path);
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
    vtkIdList* corners = grid->GetCell(cell)->GetPointIds();
    ASSERT_GT(corners->GetNumberOfIds(), 0) << path << " cell " << cell;
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k) {
      ASSERT_GE(corners->GetId(k), 0) << path;
      ASSERT_LT(corners->GetId(k), grid->GetNumberOfPoints()) << path;
    }
  }
  const auto expect_length = [&](vtkFieldData* data, vtkIdType count) {
    for (int k = 0; k < data->GetNumberOfArrays(); ++k)
      EXPECT_EQ(data->GetAbstractArray(k)->GetNumberOfTuples(), count)
          << path << ": " << data->GetAbstractArray(k)->GetName();
    expect_colours_are_named(data);
  };
  expect_length(grid->GetCellData(), grid->GetNumberOfCells());
  expect_length(grid->GetPointData(), grid->GetNumberOfPoints());
}

}  // namespace halfshade::test
