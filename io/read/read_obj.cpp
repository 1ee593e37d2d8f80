// Wavefront OBJ (Alias|Wavefront 1995, appendix B1), polygons only. A reader of our own because the
// libraries neither keep line numbers nor say what is wrong, and round coordinates in their own
// way.

#include "io/read/read_formats.h"
#include "io/read/read_text.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

namespace halfshade::reading {
namespace {

using std::filesystem::path;
using Words = std::vector<std::string_view>;

class ObjReader {
 public:
  explicit ObjReader(const path& file) : file_(file) { draft_.scene.source = file.string(); }

  SceneDraft read() {
    const std::string bytes = read_bytes(file_);
    if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
      fail(file_, 0, "the text is encoded in UTF-16; save it as UTF-8");
    LineReader lines(bytes, LineReader::Continuation::backslash);
    while (lines.next()) {
      line_ = lines.line();
      statement(lines.text());
    }
    const bool may_be_cut = bytes.back() != '\n' && bytes.back() != '\r';
    if (may_be_cut && line_of_edge_ == line_) too_few_vertices(draft_.scene.faces.size());
    check_references();
    collect_places();
    if (may_be_cut)
      draft_.warnings.push_back(
          fmt::format("{}: the last line does not end with a line break; if the file was cut "
                      "short, faces are missing",
                      place(file_, line_)));
    return std::move(draft_);
  }

 private:
  void statement(std::string_view text) {
    split(text, words_);
    // Small letters by the book; some programs write capital ones.
    const std::string keyword = lower(words_[0]);
    const std::string_view arguments = trimmed(text.substr(keyword.size()));
    if (keyword == "v") {
      vertex();
    } else if (keyword == "vt") {
      picture_place();
    } else if (keyword == "f" || keyword == "fo") {
      face();
    } else if (keyword == "g" || keyword == "o") {
      group_name_ = arguments.empty() ? default_name : std::string(arguments);
      if (!arguments.empty()) draft_.named_groups.insert(group_name_);
      group_ = -1;
    } else if (keyword == "usemtl") {
      use_material(arguments);
    } else if (keyword == "mtllib") {
      material_library(arguments);
    } else {
      unused(keyword, words_[0]);
    }
  }

  void vertex() {
    if (words_.size() < 4)
      fail(file_, line_,
           fmt::format("vertex {} has {} coordinates; it needs 3", draft_.scene.vertices.size() + 1,
                       words_.size() - 1));
    if (draft_.scene.vertices.size() >= std::numeric_limits<int>::max())
      throw Error(ErrorCode::too_large, place(file_, line_), "there are more than 2^31 vertices");
    draft_.scene.vertices.emplace_back(finite_number(words_[1], file_, line_),
                                       finite_number(words_[2], file_, line_),
                                       finite_number(words_[3], file_, line_));
  }

  /// What cannot be read counts as not there, for most files with places have no picture.
  void picture_place() {
    const auto coordinate = [&](std::size_t k) {
      return parse_double(words_[k]).value_or(std::numeric_limits<double>::quiet_NaN());
    };
    places_.emplace_back(words_.size() > 1 ? coordinate(1) : 0.,
                         words_.size() > 2 ? coordinate(2) : 0.);
  }

  void face() {
    if (words_.size() < 3) too_few_vertices(draft_.scene.faces.size() + 1);
    if (group_ < 0) group_ = group_id(draft_, group_name_);
    if (material_ < 0) material_ = material_id(draft_, default_name);
    Face face;
    face.line = line_;
    face.group = group_;
    face.material = material_;
    face.vertices.reserve(words_.size() - 1);
    place_of_corner_.emplace_back();
    for (std::size_t i = 1; i < words_.size(); ++i) {
      face.vertices.push_back(corner(words_[i]));
      place_of_corner_.back().push_back(place_index(words_[i]));
    }
    // An edge that a modeller left behind: there and back, as a face without area.
    if (face.vertices.size() == 2) {
      line_of_edge_ = line_;
      face.vertices.push_back(face.vertices.front());
      place_of_corner_.back().push_back(place_of_corner_.back().front());
    }
    draft_.scene.faces.push_back(std::move(face));
  }

  [[noreturn]] void too_few_vertices(std::size_t face) const {
    fail(file_, line_,
         fmt::format("face {} has {} vertices; a polygon needs at least 3", face,
                     words_.size() - 1));
  }

  /// The vertex, counted from 0, of "v", "v/vt", "v//vn" or "v/vt/vn". Positive indices may point
  /// ahead, so their range is checked at the end.
  int corner(std::string_view word) {
    const std::string_view first = word.substr(0, word.find('/'));
    const std::optional<long long> index = parse_integer(first);
    const std::string_view others = word.substr(first.size());
    if (!index || others.find_first_not_of("/+-0123456789") != others.npos)
      fail(file_, line_,
           fmt::format("{} in face {} is not an index such as 1, 1/2, 1//3 or 1/2/3",
                       in_quotes(word), draft_.scene.faces.size() + 1));
    const auto count = static_cast<long long>(draft_.scene.vertices.size());
    if (*index == 0)
      fail(file_, line_,
           fmt::format("face {} names vertex 0; vertices count from 1",
                       draft_.scene.faces.size() + 1));
    if (*index < -count || *index > std::numeric_limits<int>::max())
      fail(file_, line_,
           fmt::format("face {} names vertex {}, but {} vertices come before it",
                       draft_.scene.faces.size() + 1, *index, count));
    return static_cast<int>(*index > 0 ? *index - 1 : count + *index);
  }

  /// The place in a picture, counted from 0; −1 if there is none.
  long long place_index(std::string_view word) const {
    const std::size_t slash = word.find('/');
    if (slash == word.npos) return -1;
    const std::string_view rest = word.substr(slash + 1);
    const std::optional<long long> index = parse_integer(rest.substr(0, rest.find('/')));
    if (!index || *index == 0) return -1;
    return *index > 0 ? *index - 1
                      : std::max(static_cast<long long>(places_.size()) + *index, -1LL);
  }

  /// Where all corners of a face have a place that is there.
  void collect_places() {
    const auto count = static_cast<long long>(places_.size());
    for (const std::vector<long long>& corners : place_of_corner_) {
      std::vector<Vec2>& places = draft_.picture_places.emplace_back();
      if (std::any_of(corners.begin(), corners.end(), [&](long long k) {
            return k < 0 || k >= count || !places_[static_cast<std::size_t>(k)].allFinite();
          }))
        continue;
      for (const long long k : corners) places.push_back(places_[static_cast<std::size_t>(k)]);
    }
  }

  void use_material(std::string_view name) {
    if (name.empty()) fail(file_, line_, "usemtl does not name a material");
    const std::size_t known = draft_.scene.materials.size();
    material_ = material_id(draft_, std::string(name));
    if (draft_.scene.materials.size() > known)
      draft_.origins.back().undefined_place = place(file_, line_);
  }

  void material_library(std::string_view names) {
    if (names.empty()) fail(file_, line_, "mtllib does not name a file");
    // The name may contain spaces, or there may be several names.
    if (exists(beside(names))) return library(names);
    const Words several = words_;
    for (std::size_t i = 1; i < several.size(); ++i)
      library(exists(beside(several[i])) ? several[i] : names);
  }

  void library(std::string_view name) {
    const path file = beside(name);
    if (!exists(file)) {
      draft_.missing.push_back(
          {place(file_, line_), fmt::format("mtllib names {}, but there is no file '{}'",
                                            in_quotes(name), place(file, 0))});
      return;
    }
    if (!libraries_.insert(file).second) return;
    draft_.files.push_back(file);
    read_mtl(file, draft_);
  }

  static bool exists(const path& file) {
    std::error_code ignored;  // names too long, say; then there is no such file
    return std::filesystem::exists(file, ignored);
  }

  path beside(std::string_view name) const {
    std::string text(name.substr(0, name.find('\0')));
    const path file = file_.parent_path() / text;
    if (exists(file)) return file;
    std::replace(text.begin(), text.end(), '\\', '/');
    return file_.parent_path() / text;
  }

  void unused(std::string_view keyword, std::string_view as_written) {
    // Normals, smoothing, points and lines do not concern us.
    static constexpr std::string_view silent[] = {"vn", "s", "l", "p"};
    if (std::find(std::begin(silent), std::end(silent), keyword) != std::end(silent)) return;
    constexpr std::size_t most = 10;  // a file of another kind has thousands
    if (unknown_.size() < most && unknown_.insert(std::string(as_written)).second)
      draft_.warnings.push_back(fmt::format("{}: statements that begin with {} are not used",
                                            place(file_, line_), in_quotes(as_written)));
  }

  void check_references() const {
    const auto count = static_cast<int>(draft_.scene.vertices.size());
    for (std::size_t f = 0; f < draft_.scene.faces.size(); ++f)
      for (const int v : draft_.scene.faces[f].vertices)
        if (v >= count)
          fail(file_, draft_.scene.faces[f].line,
               fmt::format("face {} names vertex {}, but the file has {} vertices", f + 1,
                           static_cast<long long>(v) + 1, count));
  }

  int line_of_edge_ = -1;  ///< of the last face with two vertices
  path file_;
  SceneDraft draft_;
  Words words_;
  int line_ = 0;
  std::string group_name_ = default_name;
  int group_ = -1;                                       ///< −1 until the group has a face
  int material_ = -1;                                    ///< −1 before the first usemtl
  std::vector<Vec2> places_;                             ///< in pictures
  std::vector<std::vector<long long>> place_of_corner_;  ///< of each face; −1: none
  std::set<path> libraries_;
  std::set<std::string> unknown_;
};

}  // namespace

SceneDraft read_obj(const path& file) { return ObjReader(file).read(); }

}  // namespace halfshade::reading
