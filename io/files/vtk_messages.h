#pragma once

#include <string>

class vtkObject;

namespace halfshade::detail {

/// Catches what a VTK object would print.
struct VtkMessages {
  std::string first;  ///< the first message, without VTK's preamble of file and address

  /// Takes the errors and warnings of `object`, which must not outlive this.
  void listen_to(vtkObject* object);
  void record(vtkObject* sender, unsigned long event, void* text);
};

}  // namespace halfshade::detail
