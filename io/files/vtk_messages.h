#pragma once

#include <string>

class vtkObject;

namespace halfshade::detail {

/// Catches what a VTK object would print. To be added as observer of its error and warning events.
struct VtkMessages {
  std::string first;  ///< the first message, without VTK's preamble of file and address

  void record(vtkObject* sender, unsigned long event, void* text);
};

}  // namespace halfshade::detail
