#pragma once

#include "io/files/little_endian.h"

#include <fmt/format.h>

#include <cstdint>
#include <initializer_list>
#include <string>

/// Small files in formats that are read through assimp; glTF has a header of its own.
namespace halfshade::test {

/// A pentagon "table" 4 along the third axis of the file, of a material "paint" that emits.
inline std::string collada(const std::string& up, const std::string& meter) {
  return fmt::format(
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"
version="1.4.1"><asset><unit name="u" meter="{}"/><up_axis>{}</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="c"><lambert>
<emission><color>3 2 1 1</color></emission><diffuse><color>0.25 0.5 0.75 1</color></diffuse>
</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="paint"><instance_effect url="#e"/></material>
</library_materials>
<library_geometries><geometry id="g" name="plate"><mesh>
<source id="p"><float_array id="pa" count="15">0 0 0 1 0 0 1 1 0 0.5 2 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="5" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist material="s" count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>5</vcount><p>0 1 2 3 4</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="vs"><node id="n" name="table">
<translate>0 0 4</translate><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#vs"/></scene></COLLADA>)",
      meter, up);
}

/// A chunk of a .3ds file.
inline std::string chunk_3ds(std::uint16_t id, const std::string& content) {
  std::string bytes;
  detail::put(bytes, id);
  detail::put(bytes, static_cast<std::uint32_t>(content.size() + 6));
  return bytes + content;
}

/// A unit square "plate" in two triangles, of a material "paint" with reflectances .2, .4, .6.
inline std::string three_ds() {
  const auto shorts = [](std::initializer_list<int> values) {
    std::string bytes;
    for (const int x : values) detail::put(bytes, static_cast<std::uint16_t>(x));
    return bytes;
  };
  const auto text = [](const std::string& name) { return name + std::string(1, '\0'); };
  std::string points = shorts({4});
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, 0.F})
    detail::put(points, x);
  const std::string paint = chunk_3ds(0x4130, text("paint") + shorts({2, 0, 1}));
  const std::string faces = shorts({2, 0, 1, 2, 7, 0, 2, 3, 7}) + paint;
  const std::string mesh = chunk_3ds(0x4100, chunk_3ds(0x4110, points) + chunk_3ds(0x4120, faces));
  const std::string material =
      chunk_3ds(0xA000, text("paint")) + chunk_3ds(0xA020, chunk_3ds(0x0011, "\x33\x66\x99"));
  return chunk_3ds(0x4D4D, chunk_3ds(0x3D3D, chunk_3ds(0xAFFF, material) +
                                                 chunk_3ds(0x4000, text("plate") + mesh)));
}

}  // namespace halfshade::test
