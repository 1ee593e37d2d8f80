#include "io/files/atomic_file.h"
#include "io/picture/radiance_picture.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace halfshade {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Widths that rows can be packed for.
constexpr int least_packed = 8, most_packed = 32767;
constexpr int exponent_bias = 128;
/// A run shorter than this costs more than it saves.
constexpr std::size_t least_run = 4;
constexpr std::size_t most_run = 127, most_literals = 128;

/// Mantissas share the exponent of the largest: value = mantissa / 256 · 2^(exponent − 128).
Rgbe encode_rgbe(const Rgb& value) {
  constexpr double largest = 1.6e38;
  const Rgb v = value.max(0.).min(largest);
  int exponent = 0;
  if (!(std::frexp(v.maxCoeff(), &exponent) > 0) || exponent <= -exponent_bias) return {};
  Rgbe bytes{};
  for (int c = 0; c < 3; ++c)
    bytes[at(c)] = static_cast<std::uint8_t>(std::ldexp(v[c], 8 - exponent));
  bytes[3] = static_cast<std::uint8_t>(exponent + exponent_bias);
  return bytes;
}

std::size_t run_at(const std::vector<std::uint8_t>& row, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < row.size() && end - begin < most_run && row[end] == row[begin]) ++end;
  return end - begin;
}

/// One component of a row: runs as 128 + length and the byte, the rest as length and bytes.
void pack(const std::vector<std::uint8_t>& row, std::string& out) {
  for (std::size_t i = 0; i < row.size();) {
    if (const std::size_t run = run_at(row, i); run >= least_run) {
      out += static_cast<char>(128 + run);
      out += static_cast<char>(row[i]);
      i += run;
      continue;
    }
    std::size_t end = i + 1;
    while (end < row.size() && end - i < most_literals && run_at(row, end) < least_run) ++end;
    out += static_cast<char>(end - i);
    for (; i < end; ++i) out += static_cast<char>(row[i]);
  }
}

void add_row(const std::vector<Rgbe>& row, std::string& out) {
  const int width = static_cast<int>(row.size());
  if (width < least_packed || width > most_packed) {
    for (const Rgbe& pixel : row) out.append(pixel.begin(), pixel.end());
    return;
  }
  for (const int byte : {2, 2, width >> 8, width & 0xff}) out += static_cast<char>(byte);
  for (std::size_t c = 0; c < 4; ++c) {
    std::vector<std::uint8_t> component;
    for (const Rgbe& pixel : row) component.push_back(pixel[c]);
    pack(component, out);
  }
}

}  // namespace

void write_hdr(const RadiancePicture& picture, const std::filesystem::path& path) {
  require_format(path, radiance_formats);
  if (picture.width < 1 || picture.height < 1 ||
      picture.radiance.size() != at(picture.width) * at(picture.height))
    throw Error(ErrorCode::contract, "write_hdr",
                fmt::format("a picture of {} x {} pixels has {}", picture.width, picture.height,
                            picture.radiance.size()));
  std::string bytes = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n",
                                  picture.height, picture.width);
  auto pixel = picture.radiance.begin();
  for (int y = 0; y < picture.height; ++y) {
    std::vector<Rgbe> row;
    for (int x = 0; x < picture.width; ++x) row.push_back(encode_rgbe(*pixel++));
    add_row(row, bytes);
  }
  write_atomically(path, bytes);
}

}  // namespace halfshade
