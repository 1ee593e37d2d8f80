#include "io/picture/colour_map.h"

#include "io/picture/line_canvas.h"

#include <vtkColorTransferFunction.h>
#include <vtkNew.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace halfshade {
namespace {

/// A colour of a map, sRGB, and its place.
struct MapColour {
  double share;
  std::array<std::uint8_t, 3> bytes;
};

constexpr std::array<MapColour, 13> viridis = {{{0, {0x44, 0x01, 0x54}},
                                                {1. / 9, {0x48, 0x28, 0x78}},
                                                {2. / 9, {0x3e, 0x4a, 0x89}},
                                                {1. / 4, {0x3b, 0x52, 0x8b}},
                                                {3. / 9, {0x31, 0x68, 0x8e}},
                                                {4. / 9, {0x26, 0x82, 0x8e}},
                                                {1. / 2, {0x21, 0x90, 0x8c}},
                                                {5. / 9, {0x1f, 0x9e, 0x89}},
                                                {6. / 9, {0x35, 0xb7, 0x79}},
                                                {3. / 4, {0x5d, 0xc8, 0x63}},
                                                {7. / 9, {0x6d, 0xcd, 0x59}},
                                                {8. / 9, {0xb4, 0xde, 0x2c}},
                                                {1, {0xfd, 0xe7, 0x25}}}};
constexpr std::array<MapColour, 2> cool_to_warm = {{{0, {59, 76, 192}}, {1, {180, 4, 38}}}};
/// Linear steps between entries of the table are far below what 8 bits show.
constexpr int table_size = 513;
const Rgb not_a_number = Rgb::Constant(0.2);

void add_points(std::span<const MapColour> colours, vtkColorTransferFunction* function) {
  for (const auto& [share, bytes] : colours)
    function->AddRGBPoint(share, bytes[0] / 255., bytes[1] / 255., bytes[2] / 255.);
}

}  // namespace

ColourTable::ColourTable(ColourMap map) {
  vtkNew<vtkColorTransferFunction> function;
  if (map == ColourMap::sequential) {
    function->SetColorSpaceToLab();
    add_points(viridis, function);
  } else {
    function->SetColorSpaceToDiverging();
    add_points(cool_to_warm, function);
  }
  for (int k = 0; k < table_size; ++k) {
    std::array<double, 3> srgb{};
    function->GetColor(k / (table_size - 1.), srgb.data());
    colours_.push_back(detail::linear_of_srgb(Rgb(srgb[0], srgb[1], srgb[2])));
  }
}

Rgb ColourTable::at(double share) const {
  if (std::isnan(share)) return not_a_number;
  const double place = std::clamp(share, 0., 1.) * (table_size - 1);
  const int below = std::min(static_cast<int>(place), table_size - 2);
  const double weight = place - below;
  return (1 - weight) * colours_[halfshade::at(below)] +
         weight * colours_[halfshade::at(below + 1)];
}

}  // namespace halfshade
