// PLY (Turk 1994): text or binary, either byte order; vertices and polygons, in double precision.

#include "io/read/read_ply.h"

#include "io/read/read_formats.h"
#include "io/read/read_text.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace halfshade::reading {
namespace ply {
namespace {

class PlyReader {
 public:
  explicit PlyReader(const std::filesystem::path& file)
      : file_(file),
        bytes_(read_bytes(file)),
        header_(read_header(file, bytes_)),
        values_(file, bytes_, header_) {
    draft_.scene.source = file.string();
  }

  SceneDraft read() {
    bool has_vertices = false;
    for (const Element& element : header_.elements) {
      if (element.name == "face" && !has_vertices)
        fail(file_, 0, "the faces come before the vertices");
      has_vertices = has_vertices || element.name == "vertex";
      read(element);
    }
    if (!values_.at_end())
      draft_.warnings.push_back(file_.string() + ": what follows the last element is not used");
    return std::move(draft_);
  }

 private:
  void read(const Element& element) {
    if (element.count == 0 || element.properties.empty()) return;
    std::size_t least_size = 0;
    for (const Property& property : element.properties)
      least_size += values_.least_size(property.count_type.value_or(property.type));
    values_.require(element.count, least_size, fmt::format("elements {}", in_quotes(element.name)));
    if (element.count > std::numeric_limits<int>::max())
      throw Error(ErrorCode::too_large, file_.string(),
                  fmt::format("there are {} elements {}", element.count, in_quotes(element.name)));
    if (element.name == "vertex") {
      read_vertices(element);
    } else if (element.name == "face") {
      read_faces(element);
    } else {
      draft_.warnings.push_back(
          fmt::format("{}: elements {} are not used", file_.string(), in_quotes(element.name)));
      for (long long i = 0; i < element.count; ++i) {
        values_.set_element(element.name, i);
        for (const Property& property : element.properties) skip(property);
      }
    }
  }

  void read_vertices(const Element& element) {
    std::vector<int> axis;  // of each property, −1 for those that are no coordinates
    for (const Property& property : element.properties) {
      const bool coordinate = property.name.size() == 1 && !property.count_type &&
                              property.name[0] >= 'x' && property.name[0] <= 'z';
      axis.push_back(coordinate ? property.name[0] - 'x' : -1);
    }
    for (int c = 0; c < 3; ++c)
      if (std::count(axis.begin(), axis.end(), c) != 1)
        fail(file_, 0, fmt::format("the vertices need exactly one property {}", "xyz"[c]));
    draft_.scene.vertices.reserve(static_cast<std::size_t>(element.count));
    for (long long v = 0; v < element.count; ++v) {
      values_.set_element(element.name, v);
      Vec3& point = draft_.scene.vertices.emplace_back();
      for (std::size_t i = 0; i < axis.size(); ++i) {
        if (axis[i] < 0)
          skip(element.properties[i]);
        else
          point[axis[i]] = values_.real(element.properties[i].type);
      }
      if (!point.allFinite())
        fail(file_, values_.line(),
             fmt::format("vertex {} has the coordinates ({}, {}, {}); they must be finite", v,
                         point.x(), point.y(), point.z()));
    }
  }

  void read_faces(const Element& element) {
    const auto is_corners = [](const Property& property) {
      return (property.name == "vertex_indices" || property.name == "vertex_index") &&
             property.count_type && !is_real(property.type);
    };
    if (std::count_if(element.properties.begin(), element.properties.end(), is_corners) != 1)
      fail(file_, 0, "the faces need exactly one list 'vertex_indices' of integers");
    draft_.scene.faces.reserve(static_cast<std::size_t>(element.count));
    std::vector<long long> corners;
    for (long long f = 0; f < element.count; ++f) {
      values_.set_element(element.name, f);
      const int line = values_.next_line();
      for (const Property& property : element.properties) {
        if (!is_corners(property)) {
          skip(property);
          continue;
        }
        const long long count = list_length(property);
        corners.clear();
        for (long long i = 0; i < count; ++i) corners.push_back(values_.integer(property.type));
      }
      add_plain_face(draft_, corners, line);
    }
  }

  long long list_length(const Property& property) {
    const long long count = values_.integer(*property.count_type);
    values_.require(count, values_.least_size(property.type),
                    fmt::format("entries of {}", in_quotes(property.name)));
    return count;
  }

  void skip(const Property& property) {
    const long long count = property.count_type ? list_length(property) : 1;
    for (long long i = 0; i < count; ++i) values_.real(property.type);
  }

  std::filesystem::path file_;
  std::string bytes_;
  Header header_;
  Values values_;
  SceneDraft draft_;
};

}  // namespace
}  // namespace ply

SceneDraft read_ply(const std::filesystem::path& path) { return ply::PlyReader(path).read(); }

}  // namespace halfshade::reading
