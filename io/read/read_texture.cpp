#include "io/files/extension.h"
#include "io/files/srgb.h"
#include "io/files/vtk_messages.h"
#include "io/read/read_formats.h"
#include "io/read/read_text.h"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkJPEGReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <png.h>

namespace halfshade::reading {
namespace {

constexpr std::int64_t most_texels = 1 << 26;

[[noreturn]] void fail_damaged(const std::filesystem::path& path) {
  fail(path, 0, "the picture is damaged, or neither PNG nor JPEG");
}

void check_size(const std::filesystem::path& path, std::int64_t width, std::int64_t height) {
  if (width < 1 || height < 1) fail_damaged(path);
  if (width > most_texels / height)
    fail(path, 0,
         fmt::format("the picture has {} x {} texels; at most {} can be used", width, height,
                     most_texels));
}

/// Rows of red, green and blue from the lowest on, as they are displayed, 0 to 255.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> values;
};

/// By libpng itself: VTK's reader does not survive files that end too soon.
Picture read_png(const std::filesystem::path& path, const std::string& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> owner(&image, &png_image_free);
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) fail_damaged(path);
  check_size(path, image.width, image.height);
  // With its opacity, or colours would be mixed with black.
  image.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(image));
  const int row = -static_cast<int>(PNG_IMAGE_ROW_STRIDE(image));  // < 0: the lowest row first
  if (png_image_finish_read(&image, nullptr, rgba.data(), row, nullptr) == 0) fail_damaged(path);
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  for (std::size_t i = 0; i < rgba.size(); i += 4)
    for (std::size_t c = 0; c < 3; ++c) picture.values.push_back(rgba[i + c]);
  return picture;
}

Picture read_jpeg(const std::filesystem::path& path) {
  vtkNew<vtkJPEGReader> reader;
  detail::VtkMessages messages;
  messages.listen_to(reader);
  messages.listen_to(reader->GetExecutive());
  if (reader->CanReadFile(path.c_str()) == 0) fail_damaged(path);
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  if (reader->GetErrorCode() != 0 || !messages.first.empty()) fail_damaged(path);
  const int* extent = reader->GetDataExtent();
  check_size(path, extent[1] + std::int64_t{1}, extent[3] + std::int64_t{1});
  reader->Update();
  vtkDataArray* values = reader->GetOutput()->GetPointData()->GetScalars();
  if (reader->GetErrorCode() != 0 || !messages.first.empty() || values == nullptr)
    fail_damaged(path);
  Picture picture{extent[1] + 1, extent[3] + 1, {}};
  const int last = values->GetNumberOfComponents() - 1;  // 0: grey
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
    for (int c = 0; c < 3; ++c)
      picture.values.push_back(
          static_cast<std::uint8_t>(values->GetComponent(i, std::min(c, last))));
  return picture;
}

}  // namespace

Texture read_texture(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  const std::string extension = extension_of(path);
  if (extension != ".png" && extension != ".jpg" && extension != ".jpeg")
    fail(path, 0, "pictures are read from .png and .jpg files only");
  const Picture picture = extension == ".png" ? read_png(path, bytes) : read_jpeg(path);
  std::array<float, 256> linear;
  for (std::size_t k = 0; k < linear.size(); ++k)
    linear[k] = static_cast<float>(detail::from_srgb(static_cast<double>(k) / 255));
  std::vector<Eigen::Array3f> texels;
  for (std::size_t i = 0; i < picture.values.size(); i += 3)
    texels.emplace_back(linear[picture.values[i]], linear[picture.values[i + 1]],
                        linear[picture.values[i + 2]]);
  return make_texture(path.string(), picture.width, picture.height, std::move(texels));
}

}  // namespace halfshade::reading
