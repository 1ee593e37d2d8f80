// View3D's vertices and surfaces (Walton, Calculation of obstructed view factors by adaptive
// integration, NISTIR 6925, 2002), in its format F = 3.

#include "io/read/read_formats.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade::reading {
namespace {

/// The group and the material of surfaces that only obstruct.
constexpr const char* obstructions = "obstructions";

/// How far a part may be off the plane of its base, of its size.
constexpr double flat = 1e-5;

/// A surface that is a part of another one, both counted from 0, and the line that says so.
struct Base {
  std::size_t part, of;
  int line;
};

class Vs3Reader {
 public:
  explicit Vs3Reader(const std::filesystem::path& file) : file_(file) {
    draft_.scene.source = file.string();
  }

  SceneDraft read() {
    const std::string bytes = read_bytes(file_);
    LineReader lines(bytes);
    while (!has_ended_ && lines.next()) {
      line_ = lines.line();
      split(lines.text(), words_);
      cut_comment();
      if (!words_.empty()) statement();
    }
    for (const Base& base : bases_) require_base(base);
    if (has_obstructions_)
      draft_.warnings.push_back(
          fmt::format("{}: surfaces that only obstruct (O) are taken as black and cold, and have a "
                      "row of their own: the group '{}'",
                      file_.string(), obstructions));
    return std::move(draft_);
  }

 private:
  /// A word that begins with ! or / and all that follows it.
  void cut_comment() {
    words_.erase(
        std::find_if(words_.begin(), words_.end(),
                     [](std::string_view word) { return word[0] == '!' || word[0] == '/'; }),
        words_.end());
  }

  /// The first letter alone tells what a line is.
  void statement() {
    switch (lower(words_[0].substr(0, 1))[0]) {
      case 'v':
        return vertex();
      case 's':
        return radiating_surface();
      case 'o':
        return obstruction();
      case 'f':
        return geometry();
      case 'm':
        reject("masking surfaces (M) are not supported; cut what they cover out of their base");
      case 'n':
        reject("null surfaces (N) are not supported; cut what they cover out of their base");
      case 'x':
        reject("transformations (X) are not supported; give transformed vertices");
      case 't':
      case 'c':  // what View3D is to compute, and how
        return;
      case 'e':
      case '*':
        has_ended_ = true;
        return;
      default:
        reject(fmt::format("{} begins no line of a .vs3 file", in_quotes(words_[0])));
    }
  }

  void geometry() {
    const std::string_view kind = words_.size() > 1 ? words_[1] : words_[0].substr(1);
    if (kind != "3")
      reject(
          fmt::format("the geometry is of the kind F {}; only F 3, vertices and surfaces in "
                      "space, can be read",
                      in_quotes(kind)));
  }

  void vertex() {
    if (words_.size() < 5)
      reject(fmt::format("a vertex has a number and 3 coordinates, but {} words follow here",
                         words_.size() - 1));
    require_next(draft_.scene.vertices.size(), "vertex");
    draft_.scene.vertices.emplace_back(finite_number(words_[2], file_, line_),
                                       finite_number(words_[3], file_, line_),
                                       finite_number(words_[4], file_, line_));
  }

  /// "S number v1 v2 v3 v4 base combined-with emissivity name"
  void radiating_surface() {
    if (words_.size() < 9)
      reject(fmt::format("a surface has 8 numbers and a name, but {} words follow here",
                         words_.size() - 1));
    require_next(groups_.size(), "surface");
    const std::vector<long long> corners = read_corners();
    // A part of another surface is cut out of it by the repair, like any smaller coplanar face.
    if (const long long base = whole(6); base > 0)
      bases_.push_back({groups_.size(), static_cast<std::size_t>(base) - 1, line_});
    const long long combined = whole(7);
    if (combined > static_cast<long long>(groups_.size()) ||
        (combined > 0 && groups_[static_cast<std::size_t>(combined) - 1] == obstructions))
      reject(
          fmt::format("surface {} is combined with surface {}, which is none before it that "
                      "radiates",
                      groups_.size() + 1, combined));
    const double emissivity = number(words_[8], file_, line_);
    if (!(emissivity >= 0 && emissivity <= 1))
      reject(fmt::format("surface {} has emissivity {}; it must lie in [0, 1]", groups_.size() + 1,
                         emissivity));
    if (combined > 0)
      groups_.push_back(groups_[static_cast<std::size_t>(combined) - 1]);
    else
      groups_.push_back(words_.size() > 9 ? std::string(words_[9])
                                          : fmt::format("surface {}", groups_.size() + 1));
    add_surface(corners, fmt::format("emissivity {}", emissivity), 1 - emissivity);
  }

  /// "O number v1 v2 v3 v4"
  void obstruction() {
    if (words_.size() < 6)
      reject(
          fmt::format("an obstruction has 5 numbers, but {} words follow here", words_.size() - 1));
    require_next(groups_.size(), "surface");
    const std::vector<long long> corners = read_corners();
    groups_.emplace_back(obstructions);
    has_obstructions_ = true;
    add_surface(corners, obstructions, 0);
  }

  void add_surface(const std::vector<long long>& corners, const std::string& material, double rho) {
    add_face(draft_, corners, line_, groups_.back(), material);
    const auto id = static_cast<std::size_t>(draft_.scene.faces.back().material);
    draft_.scene.materials[id].rho = Rgb::Constant(rho);
    draft_.origins[id].rho_place = place(file_, line_);
  }

  /// Counted from 0; a fourth number of 0 makes a triangle.
  std::vector<long long> read_corners() const {
    const auto count = static_cast<long long>(draft_.scene.vertices.size());
    std::vector<long long> corners;
    for (std::size_t k = 2; k < 6; ++k) {
      const long long vertex = whole(k);
      if (k == 5 && vertex == 0) break;
      if (vertex < 1 || vertex > count)
        reject(fmt::format("surface {} names vertex {}, but {}", groups_.size() + 1, vertex,
                           count == 0 ? "no vertices come before it"
                                      : fmt::format("vertices are numbered from 1 to {}", count)));
      corners.push_back(vertex - 1);
    }
    return corners;
  }

  long long whole(std::size_t word) const {
    const std::optional<long long> value = parse_integer(words_[word]);
    if (!value || *value < 0)
      reject(fmt::format("{} is not a number of a vertex or surface", in_quotes(words_[word])));
    return *value;
  }

  /// A part of a surface lies in its plane and faces the same way; else the repair would not cut it
  /// out.
  void require_base(const Base& base) const {
    if (base.of >= groups_.size())
      fail(file_, base.line,
           fmt::format("the base is surface {}, but the file has {} surfaces", base.of + 1,
                       groups_.size()));
    const std::vector<Vec3> part = corners_of(base.part), whole = corners_of(base.of);
    const Vec3 normal = area_vector(whole);
    double off = 0;
    for (const Vec3& corner : part)
      off = std::max(off, std::abs(normal.normalized().dot(corner - whole[0])));
    if (!(area_vector(part).dot(normal) > 0) || off > flat * std::sqrt(normal.norm()))
      fail(file_, base.line,
           fmt::format("surface {} does not lie in the plane of its base, surface {}, or faces the "
                       "other way",
                       base.part + 1, base.of + 1));
  }

  std::vector<Vec3> corners_of(std::size_t surface) const {
    std::vector<Vec3> corners;
    for (const int v : draft_.scene.faces[surface].vertices)
      corners.push_back(draft_.scene.vertices[static_cast<std::size_t>(v)]);
    return corners;
  }

  /// Of a triangle or a quadrilateral, twice its area long.
  static Vec3 area_vector(const std::vector<Vec3>& p) {
    return (p[2] - p[0]).cross(p.back() - p[1]);
  }

  /// They must be numbered 1, 2, 3, …
  void require_next(std::size_t count, const char* what) const {
    if (whole(1) != static_cast<long long>(count) + 1)
      reject(fmt::format("this is {} {}, but {} {} is expected here", what, words_[1], what,
                         count + 1));
  }

  [[noreturn]] void reject(const std::string& sentence) const { fail(file_, line_, sentence); }

  std::filesystem::path file_;
  SceneDraft draft_;
  std::vector<std::string_view> words_;
  int line_ = 0;
  std::vector<std::string> groups_;  ///< of the surfaces so far
  std::vector<Base> bases_;
  bool has_ended_ = false;
  bool has_obstructions_ = false;
};

}  // namespace

SceneDraft read_vs3(const std::filesystem::path& path) { return Vs3Reader(path).read(); }

}  // namespace halfshade::reading
