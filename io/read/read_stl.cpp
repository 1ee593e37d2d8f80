// STL (3D Systems 1988), as text or binary. A reader of our own, because solids may have names with
// spaces and keywords may be written in capital letters, and to name the line of a mistake.

#include "io/read/read_formats.h"
#include "io/read/read_text.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <limits>

namespace halfshade::reading {
namespace {

constexpr std::size_t header_size = 84, facet_size = 50;

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Appends a triangle whose corners are the last three vertices.
void add_triangle(SceneDraft& draft, const std::string& group, int line) {
  Face face;
  face.line = line;
  face.group = group_id(draft, group);
  face.material = material_id(draft, default_name);
  const auto count = draft.scene.vertices.size();
  if (count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw Error(ErrorCode::too_large, draft.scene.source, "there are more than 2^31 vertices");
  const int end = static_cast<int>(count);
  face.vertices = {end - 3, end - 2, end - 1};
  draft.scene.faces.push_back(std::move(face));
}

class TextReader {
 public:
  TextReader(const std::filesystem::path& file, std::string_view bytes, SceneDraft& draft)
      : file_(file), lines_(bytes), draft_(draft) {}

  void read() {
    while (lines_.next()) {
      split(lines_.text(), words_);
      statement(lower(words_[0]));
    }
    if (in_solid_) fail(file_, 0, fmt::format("the file ends within solid {}", in_quotes(name_)));
  }

 private:
  void statement(const std::string& keyword) {
    if (keyword == "solid") {
      require(!in_solid_, "the solid before it has no end");
      name_ = trimmed(lines_.text().substr(words_[0].size()));
      in_solid_ = true;
    } else if (keyword == "vertex") {
      vertex();
    } else if (keyword == "endloop" || keyword == "endfacet") {
      require(corners_ % 3 == 0, "a facet needs 3 vertices");
    } else if (keyword == "endsolid") {
      require(in_solid_ && corners_ % 3 == 0, "there is no solid or no facet that could end here");
      in_solid_ = false;
    } else {
      require(keyword == "facet" || keyword == "outer",
              fmt::format("{} is not a keyword of STL files", in_quotes(words_[0])));
      if (keyword == "facet") facet_line_ = lines_.line();
      require(corners_ % 3 == 0, "the facet before it does not have 3 vertices");
    }
  }

  void vertex() {
    require(in_solid_, "a vertex stands outside any solid");
    require(words_.size() == 4,
            fmt::format("a vertex has {} coordinates; it needs 3", words_.size() - 1));
    Vec3 point;
    for (int c = 0; c < 3; ++c)
      point[c] = finite_number(words_[static_cast<std::size_t>(c) + 1], file_, lines_.line());
    draft_.scene.vertices.push_back(point);
    if (++corners_ % 3 == 0)
      add_triangle(draft_, name_.empty() ? default_name : name_, facet_line_);
  }

  void require(bool condition, const std::string& sentence) const {
    if (!condition) fail(file_, lines_.line(), sentence);
  }

  std::filesystem::path file_;
  LineReader lines_;
  SceneDraft& draft_;
  std::vector<std::string_view> words_;
  std::string name_;
  bool in_solid_ = false;
  int facet_line_ = 0;
  long long corners_ = 0;
};

/// Precondition: the bytes hold all facets.
void read_binary(std::string_view bytes, SceneDraft& draft) {
  const std::uint32_t count = little_endian(bytes, header_size - 4);
  for (std::size_t f = 0; f < count; ++f) {
    // A normal, which the corners give, too; three corners; two bytes without a meaning.
    const std::size_t corners = header_size + f * facet_size + 12;
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3& point = draft.scene.vertices.emplace_back();
      for (std::size_t c = 0; c < 3; ++c)
        point[static_cast<int>(c)] = static_cast<double>(
            std::bit_cast<float>(little_endian(bytes, corners + 12 * k + 4 * c)));
    }
    add_triangle(draft, default_name, 0);
  }
}

/// The size that a binary file says it has.
std::size_t binary_size(std::string_view bytes) {
  return bytes.size() < header_size
             ? header_size
             : header_size + facet_size * std::size_t{little_endian(bytes, header_size - 4)};
}

}  // namespace

SceneDraft read_stl(const std::filesystem::path& path) {
  SceneDraft draft;
  draft.scene.source = path.string();
  const std::string bytes = read_bytes(path);
  const std::size_t size = binary_size(bytes);
  // The header of a binary file may begin with any word.
  const bool is_text = bytes.size() != size && lower(bytes.substr(0, 5)) == "solid";
  if (is_text) {
    TextReader(path, bytes, draft).read();
    return draft;
  }
  if (bytes.size() < size)
    fail(path, 0,
         fmt::format("a binary STL file of this header has {} bytes, but there are {}; the file is "
                     "cut short, or it is none",
                     size, bytes.size()));
  read_binary(bytes, draft);
  if (bytes.size() > size)
    draft.warnings.push_back(path.string() + ": what follows the last facet is not used");
  return draft;
}

}  // namespace halfshade::reading
