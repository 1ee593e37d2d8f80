#include "io/files/srgb.h"
#include "io/read/read_formats.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>  // jpeglib.h takes it for granted
#include <jpeglib.h>
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
  // Those of 16 bits are as the others, where the file does not say otherwise.
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
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

/// By libjpeg itself: VTK's reader prints, and takes what is missing as grey.
class JpegReader {
 public:
  explicit JpegReader(const std::string& bytes) : bytes_(bytes) {
    info_.err = jpeg_std_error(&errors_.manager);
    errors_.manager.error_exit = [](j_common_ptr info) {
      std::longjmp(reinterpret_cast<Errors*>(info->err)->back, 1);
    };
    errors_.manager.output_message = [](j_common_ptr) {};
    jpeg_create_decompress(&info_);
  }
  ~JpegReader() { jpeg_destroy_decompress(&info_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  // Nothing that has a destructor may live in functions that libjpeg jumps back to.

  /// False if there is no header.
  bool read_header() {
    if (setjmp(errors_.back) != 0) return false;
    jpeg_mem_src(&info_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
    jpeg_read_header(&info_, TRUE);
    info_.out_color_space = JCS_RGB;
    return true;
  }
  std::int64_t width() const { return info_.image_width; }
  std::int64_t height() const { return info_.image_height; }

  /// Into rows from the lowest on. False if anything is missing or wrong.
  bool read_rows(std::uint8_t* values) {
    if (setjmp(errors_.back) != 0) return false;
    jpeg_start_decompress(&info_);
    while (info_.output_scanline < info_.output_height) {
      JSAMPROW row = values + std::size_t{3} * info_.output_width *
                                  (info_.output_height - 1 - info_.output_scanline);
      jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_finish_decompress(&info_);
    return errors_.manager.num_warnings == 0;
  }

 private:
  struct Errors {
    jpeg_error_mgr manager;  // must be the first
    std::jmp_buf back;
  };

  const std::string& bytes_;
  jpeg_decompress_struct info_{};
  Errors errors_{};
};

Picture read_jpeg(const std::filesystem::path& path, const std::string& bytes) {
  JpegReader reader(bytes);
  if (!reader.read_header()) fail_damaged(path);
  check_size(path, reader.width(), reader.height());
  Picture picture{static_cast<int>(reader.width()), static_cast<int>(reader.height()), {}};
  picture.values.resize(static_cast<std::size_t>(3 * reader.width() * reader.height()));
  if (!reader.read_rows(picture.values.data())) fail_damaged(path);
  return picture;
}

}  // namespace

Texture read_texture(const std::filesystem::path& path, const std::string& bytes) {
  const bool is_jpeg = bytes.starts_with("\xff\xd8");
  const Picture picture = is_jpeg ? read_jpeg(path, bytes) : read_png(path, bytes);
  std::array<float, 256> linear;
  for (std::size_t k = 0; k < linear.size(); ++k)
    linear[k] = static_cast<float>(detail::from_srgb(static_cast<double>(k) / 255));
  std::vector<Eigen::Array3f> texels;
  for (std::size_t i = 0; i < picture.values.size(); i += 3)
    texels.emplace_back(linear[picture.values[i]], linear[picture.values[i + 1]],
                        linear[picture.values[i + 2]]);
  return make_texture(path.string(), picture.width, picture.height, std::move(texels));
}

std::filesystem::path find_picture(const std::filesystem::path& scene, std::string_view name) {
  std::string text(name.substr(0, name.find('\0')));
  const auto beside = [&](const std::filesystem::path& path) {
    std::error_code ignored;
    const std::filesystem::path file = scene.parent_path() / path;
    return std::filesystem::is_regular_file(file, ignored) ? file : std::filesystem::path();
  };
  if (const auto file = beside(text); !file.empty()) return file;
  std::replace(text.begin(), text.end(), '\\', '/');
  if (const auto file = beside(text); !file.empty()) return file;
  return beside(std::filesystem::path(text).filename());
}

}  // namespace halfshade::reading
