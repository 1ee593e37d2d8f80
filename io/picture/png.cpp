#include "io/files/atomic_file.h"
#include "io/files/vtk_messages.h"
#include "io/picture/picture.h"
#include "meshing/core/error.h"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace halfshade {

void write_png(const Picture& picture, const std::filesystem::path& path) {
  require_format(path, picture_formats);
  const auto row = static_cast<std::ptrdiff_t>(picture.width) * 3;
  if (picture.width < 1 || picture.height < 1 ||
      static_cast<std::ptrdiff_t>(picture.pixels.size()) != row * picture.height)
    throw Error(ErrorCode::contract, "write_png",
                fmt::format("a picture of {} x {} pixels has {} bytes", picture.width,
                            picture.height, picture.pixels.size()));
  vtkNew<vtkImageData> image;
  image->SetDimensions(picture.width, picture.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* out = static_cast<unsigned char*>(image->GetScalarPointer());
  for (int y = picture.height - 1; y >= 0; --y)  // VTK has the bottom row first
    out = std::copy_n(picture.pixels.begin() + y * row, row, out);

  detail::VtkMessages messages;
  vtkNew<vtkPNGWriter> writer;
  messages.listen_to(writer);
  writer->SetInputData(image);
  if (!picture.comment.empty()) writer->AddText("Comment", picture.comment.c_str());
  writer->WriteToMemoryOn();
  writer->Write();
  const vtkUnsignedCharArray* bytes = writer->GetResult();
  if (!messages.first.empty() || writer->GetErrorCode() != 0 || bytes == nullptr)
    throw Error(ErrorCode::unwritable, path.string(), "the picture could not be encoded");
  const auto* begin = reinterpret_cast<const char*>(writer->GetResult()->GetPointer(0));
  write_atomically(path,
                   std::string_view(begin, static_cast<std::size_t>(bytes->GetNumberOfValues())));
}

}  // namespace halfshade
