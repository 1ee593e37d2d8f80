#include "io/files/vtk_messages.h"

#include <vtkCommand.h>

#include <string_view>

namespace halfshade::detail {

void VtkMessages::listen_to(vtkObject* object) {
  for (const unsigned long event : {vtkCommand::ErrorEvent, vtkCommand::WarningEvent})
    object->AddObserver(event, this, &VtkMessages::record);
}

void VtkMessages::record(vtkObject*, unsigned long, void* text) {
  if (!first.empty() || text == nullptr) return;
  // "ERROR: In file.cxx, line 1\nvtkClass (0x1): what happened\n\n"
  std::string_view message = static_cast<const char*>(text);
  if (const auto preamble = message.find("): "); preamble != message.npos)
    message.remove_prefix(preamble + 3);
  first = message.substr(0, message.find('\n'));
}

}  // namespace halfshade::detail
