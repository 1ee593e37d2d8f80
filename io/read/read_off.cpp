// Object File Format of Geomview (OFF, COFF, NOFF, STOFF and their combinations, as text).

#include "io/read/read_formats.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <array>

namespace halfshade::reading {
namespace {

class OffReader {
 public:
  explicit OffReader(const std::filesystem::path& file)
      : file_(file), bytes_(read_bytes(file)), lines_(bytes_) {
    draft_.scene.source = file.string();
  }

  SceneDraft read() {
    next("its header");
    header();
    const auto [vertices, faces] = counts();
    draft_.scene.vertices.reserve(static_cast<std::size_t>(vertices));
    for (long long v = 0; v < vertices; ++v) {
      next("vertex", v);
      vertex(v);
    }
    draft_.scene.faces.reserve(static_cast<std::size_t>(faces));
    for (long long f = 0; f < faces; ++f) {
      next("face", f + 1);
      face(f);
    }
    if (lines_.next())
      draft_.warnings.push_back(
          fmt::format("{}: what follows the last face is not used", place(file_, lines_.line())));
    return std::move(draft_);
  }

 private:
  /// Cuts the next line into words; `what` and its number say what is expected there.
  void next(std::string_view what, long long number = -1) {
    if (!lines_.next())
      fail(file_, 0,
           number < 0 ? fmt::format("the file ends before {}", what)
                      : fmt::format("the file ends before {} {}", what, number));
    split(lines_.text(), words_);
  }

  /// Takes the keyword off; the counts may follow on its line or on the next.
  void header() {
    const std::string word = lower(words_[0]);
    std::string_view keyword = word;
    for (const std::string_view prefix : {"st", "c", "n"})
      if (keyword.starts_with(prefix)) keyword.remove_prefix(prefix.size());
    if (keyword == "off") {
      words_.erase(words_.begin());
    } else if (!parse_integer(words_[0])) {
      fail(file_, lines_.line(),
           fmt::format("{} is not a kind of OFF file that can be read; it must be OFF, COFF, NOFF "
                       "or STOFF",
                       in_quotes(words_[0])));
    }
    if (!words_.empty() && lower(words_[0]) == "binary")
      fail(file_, lines_.line(), "binary OFF files cannot be read; save it as text");
    if (words_.empty()) next("the numbers of vertices and faces");
  }

  std::array<long long, 2> counts() {
    if (words_.size() < 2)
      fail(file_, lines_.line(), "the numbers of vertices and faces are expected here");
    std::array<long long, 2> result{};
    for (std::size_t i = 0; i < 2; ++i) {
      const std::optional<long long> count = parse_integer(words_[i]);
      if (!count || *count < 0)
        fail(file_, lines_.line(),
             fmt::format("{} is not a number of {}", in_quotes(words_[i]),
                         i == 0 ? "vertices" : "faces"));
      result[i] = *count;
    }
    // The shortest vertex is "0 0 0\n", the shortest face "3 0 0 0\n".
    const auto size = static_cast<long long>(bytes_.size());
    if (result[0] > size / 6 + 1 || result[1] > size / 8 + 1)
      fail(file_, lines_.line(),
           fmt::format("{} vertices and {} faces do not fit into the file's {} bytes; it is cut "
                       "short, or the numbers are wrong",
                       result[0], result[1], size));
    return result;
  }

  void vertex(long long v) {
    if (words_.size() < 3)
      fail(file_, lines_.line(),
           fmt::format("vertex {} has {} coordinates; it needs 3", v, words_.size()));
    Vec3 point;
    for (int c = 0; c < 3; ++c)
      point[c] = finite_number(words_[static_cast<std::size_t>(c)], file_, lines_.line());
    draft_.scene.vertices.push_back(point);
  }

  void face(long long f) {
    const std::optional<long long> count = parse_integer(words_[0]);
    if (!count || *count < 0)
      fail(file_, lines_.line(),
           fmt::format("{} is not the number of corners of face {}", in_quotes(words_[0]), f + 1));
    if (static_cast<long long>(words_.size()) - 1 < *count)
      fail(file_, lines_.line(),
           fmt::format("face {} should have {} corners, but {} numbers follow", f + 1, *count,
                       words_.size() - 1));
    corners_.clear();
    for (std::size_t i = 1; i <= static_cast<std::size_t>(*count); ++i) {
      const std::optional<long long> index = parse_integer(words_[i]);
      if (!index)
        fail(file_, lines_.line(),
             fmt::format("{} in face {} is not a vertex number", in_quotes(words_[i]), f + 1));
      corners_.push_back(*index);
    }
    add_plain_face(draft_, corners_, lines_.line());
  }

  std::filesystem::path file_;
  std::string bytes_;
  LineReader lines_;
  SceneDraft draft_;
  std::vector<std::string_view> words_;
  std::vector<long long> corners_;
};

}  // namespace

SceneDraft read_off(const std::filesystem::path& path) { return OffReader(path).read(); }

}  // namespace halfshade::reading
