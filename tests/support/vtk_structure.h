#pragma once

#include "tests/support/files.h"
#include "tests/support/vtk_reading.h"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkPointData.h>

#include <regex>
#include <set>
#include <string>

/// What programs other than ours ask of a VTK file.
namespace halfshade::test {

/// Attributes of the tags named DataArray or Array, one string each.
inline std::vector<std::string> array_tags(const std::string& xml) {
  static const std::regex tag("<(Data)?Array [^>]*>");
  std::vector<std::string> tags;
  for (std::sregex_iterator it(xml.begin(), xml.end(), tag), end; it != end; ++it)
    tags.push_back(it->str());
  return tags;
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
    EXPECT_TRUE(std::regex_search(tag, std::regex("type=\"(Float|U?Int)(8|32|64)\""))) << tag;
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
