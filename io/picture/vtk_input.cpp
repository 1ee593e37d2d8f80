#include "io/picture/detail/vtk_input.h"

#include "io/files/extension.h"
#include "io/files/seal.h"
#include "io/files/vtk_messages.h"
#include "meshing/core/error.h"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <fstream>
#include <sstream>

namespace halfshade::detail {

using std::filesystem::path;

void reject(const path& file, const std::string& sentence) {
  throw Error(ErrorCode::invalid_input, file.string(), sentence);
}

namespace {

/// Reader, parser and pipeline print what they meet unless someone listens.
template <class Reader>
vtkSmartPointer<vtkPointSet> decoded(const std::string& bytes, const path& file) {
  VtkMessages messages;
  vtkNew<vtkCallbackCommand> listener;
  listener->SetClientData(&messages);
  listener->SetCallback([](vtkObject* sender, unsigned long event, void* client, void* text) {
    static_cast<VtkMessages*>(client)->record(sender, event, text);
  });
  vtkNew<Reader> reader;
  for (const unsigned long event : {vtkCommand::ErrorEvent, vtkCommand::WarningEvent}) {
    reader->AddObserver(event, listener);
    reader->GetExecutive()->AddObserver(event, listener);
  }
  reader->SetReaderErrorObserver(listener);
  reader->SetParserErrorObserver(listener);
  reader->ReadFromInputStringOn();
  reader->SetInputString(bytes);
  try {
    reader->Update();
  } catch (const std::exception&) {  // sizes that are not there, for example
    reject(file, "the data in the file cannot be decoded");
  }
  if (!messages.first.empty()) reject(file, "the data in the file cannot be decoded");
  return reader->GetOutput();
}

}  // namespace

vtkSmartPointer<vtkPointSet> read_sealed(const path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) reject(file, "this is a folder, not a file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) reject(file, "the file cannot be opened");
  std::ostringstream contents;
  contents << stream.rdbuf();
  const std::string bytes = std::move(contents).str();
  if (!is_sealed(bytes))
    reject(file,
           "this is no result of halfshade, or it is damaged or was changed by another program");
  return extension_of(file) == ".vtu" ? decoded<vtkXMLUnstructuredGridReader>(bytes, file)
                                      : decoded<vtkXMLPolyDataReader>(bytes, file);
}

/// The points that a cell names.
std::vector<int> nodes_of(vtkPointSet* grid, vtkIdType cell, const path& file) {
  vtkNew<vtkIdList> ids;
  grid->GetCellPoints(cell, ids);
  std::vector<int> nodes;
  for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k) {
    const vtkIdType p = ids->GetId(k);
    if (p < 0 || p >= grid->GetNumberOfPoints())
      reject(file, fmt::format("cell {} names point {}, but there are {}", cell, p,
                               grid->GetNumberOfPoints()));
    nodes.push_back(static_cast<int>(p));
  }
  return nodes;
}

std::vector<Vec3> points_of(vtkPointSet* grid, const path& file) {
  std::vector<Vec3> points;
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) {
    Vec3 p;
    grid->GetPoint(i, p.data());
    if (!p.allFinite()) reject(file, fmt::format("the coordinates of point {} are not finite", i));
    points.push_back(p);
  }
  return points;
}

}  // namespace halfshade::detail
