// Meshes of Gmsh (Geuzaine and Remacle 2009), formats 2 and 4.1 as text: triangles and
// quadrangles, with physical groups as groups.

#include "io/read/msh_mesh.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <array>

namespace halfshade::reading {
namespace {

class MshReader {
 public:
  explicit MshReader(const std::filesystem::path& file)
      : file_(file), bytes_(read_bytes(file)), lines_(bytes_), mesh_(file) {}

  SceneDraft read() {
    next("$MeshFormat");
    if (words_[0] != "$MeshFormat")
      reject("a .msh file begins with $MeshFormat; others, also of format 1, cannot be read");
    if (is_binary_format()) return read_binary_msh(file_, bytes_);
    end("$EndMeshFormat");
    while (lines_.next()) {
      split(lines_.text(), words_);
      section();
    }
    return mesh_.finish();
  }

 private:
  void next(std::string_view what) {
    if (!lines_.next()) fail(file_, 0, fmt::format("the file ends before {}", what));
    split(lines_.text(), words_);
  }

  /// The line must have as many words.
  void next(std::string_view what, std::size_t words) {
    next(what);
    if (words_.size() < words)
      reject(fmt::format("{} should have {} numbers here, but there are {}", what, words,
                         words_.size()));
  }

  bool is_binary_format() {
    next("its format", 2);
    const std::string_view version = words_[0];
    is_new_ = version == "4.1";
    if (!is_new_ && version != "2" && !version.starts_with("2."))
      reject(fmt::format("format {} cannot be read; save it as format 4.1 or 2.2",
                         in_quotes(version)));
    if (words_[1] != "0" && words_[1] != "1")
      reject(fmt::format("the kind of file is {}; it must be 0 (text) or 1 (binary)",
                         in_quotes(words_[1])));
    return words_[1] == "1";
  }

  void section() {
    if (words_[0] == "$PhysicalNames") return names();
    if (words_[0] == "$Nodes") return is_new_ ? node_blocks() : nodes();
    if (words_[0] == "$Elements") return is_new_ ? element_blocks() : elements();
    if (words_[0] == "$Entities" && is_new_) return entities();
    if (words_[0] == "$PartitionedEntities")
      reject("meshes that are cut into partitions cannot be read; save it without them");
    if (!words_[0].starts_with('$'))
      reject(fmt::format("{} stands where a section ($…) should begin", in_quotes(words_[0])));
    const std::string last = "$End" + std::string(words_[0].substr(1));
    do next(last);
    while (words_[0] != last);
  }

  void end(std::string_view name) {
    next(name);
    if (words_[0] != name)
      reject(fmt::format("{} is expected here, not {}", name, in_quotes(words_[0])));
  }

  void names() {
    next("the number of names");
    for (long long n = count(0); n > 0; --n) {
      next("a physical name", 3);
      mesh_.add_name(lines_.text(), lines_.line());
    }
    end("$EndPhysicalNames");
  }

  void nodes() {
    next("the number of nodes");
    for (long long n = count(0); n > 0; --n) {
      next("a node", 4);
      add_node(whole(0), 1);
    }
    end("$EndNodes");
  }

  void node_blocks() {
    next("the numbers of nodes", 4);
    std::vector<long long> tags;
    for (long long blocks = count(0); blocks > 0; --blocks) {
      next("a block of nodes", 4);
      tags.clear();
      for (long long n = count(3); n > 0; --n) {
        next("the number of a node");
        tags.push_back(whole(0));
      }
      for (const long long tag : tags) {
        next("a node", 3);
        add_node(tag, 0);
      }
    }
    end("$EndNodes");
  }

  void add_node(long long tag, std::size_t first_word) {
    Vec3 point;
    for (std::size_t c = 0; c < 3; ++c)
      point[static_cast<int>(c)] = finite_number(words_[first_word + c], file_, lines_.line());
    mesh_.add_node(tag, point, lines_.line());
  }

  void entities() {
    next("the numbers of entities", 4);
    const std::array<long long, 4> counts{count(0), count(1), count(2), count(3)};
    for (std::size_t dimension = 0; dimension < 4; ++dimension)
      for (long long n = counts[dimension]; n > 0; --n) {
        next("an entity", dimension == 0 ? 5 : 8);
        if (dimension != 2) continue;
        const long long groups = count(7);
        if (static_cast<long long>(words_.size()) - 8 < groups)
          reject("the physical groups of a surface are expected here");
        numbers_.clear();
        for (long long k = 0; k < groups; ++k)
          numbers_.push_back(whole(8 + static_cast<std::size_t>(k)));
        mesh_.add_surface(whole(0), numbers_, lines_.line());
      }
    end("$EndEntities");
  }

  /// "number type tags tag… node…", the first tag the physical group.
  void elements() {
    next("the number of elements");
    for (long long n = count(0); n > 0; --n) {
      next("an element", 3);
      if (!mesh_.is_face(whole(1), lines_.line())) continue;
      const long long tags = count(2);
      const std::size_t size = whole(1) == 2 ? 3 : 4;
      if (tags > static_cast<long long>(words_.size()) ||
          words_.size() < 3 + static_cast<std::size_t>(tags) + size)
        reject(fmt::format("element {} has {} words; {} tags and {} nodes are more", words_[0],
                           words_.size(), tags, size));
      add_face(tags > 0 ? whole(3) : 0, 3 + static_cast<std::size_t>(tags), size);
    }
    end("$EndElements");
  }

  void element_blocks() {
    next("the numbers of elements", 4);
    for (long long blocks = count(0); blocks > 0; --blocks) {
      next("a block of elements", 4);
      const long long type = whole(2);
      const long long group = mesh_.group_of(whole(1));
      for (long long n = count(3); n > 0; --n) {
        next("an element", type == 3 ? 5 : type == 2 ? 4 : 1);
        if (mesh_.is_face(type, lines_.line())) add_face(group, 1, type == 2 ? 3 : 4);
      }
    }
    end("$EndElements");
  }

  /// `first_word` has the first of the nodes.
  void add_face(long long group, std::size_t first_word, std::size_t size) {
    numbers_.clear();
    for (std::size_t k = 0; k < size; ++k) numbers_.push_back(whole(first_word + k));
    mesh_.add_face(whole(0), numbers_, group, lines_.line());
  }

  long long whole(std::size_t word) const {
    const std::optional<long long> value = parse_integer(words_[word]);
    if (!value) reject(fmt::format("{} is not a whole number", in_quotes(words_[word])));
    return *value;
  }

  long long count(std::size_t word) const {
    const long long value = whole(word);
    if (value < 0) reject(fmt::format("{} is not a number of things", value));
    return value;
  }

  [[noreturn]] void reject(const std::string& sentence) const {
    fail(file_, lines_.line(), sentence);
  }

  std::filesystem::path file_;
  std::string bytes_;
  LineReader lines_;
  MshMesh mesh_;
  std::vector<std::string_view> words_;
  std::vector<long long> numbers_;
  bool is_new_ = false;  ///< 4.1, not 2
};

}  // namespace

SceneDraft read_msh(const std::filesystem::path& path) { return MshReader(path).read(); }

}  // namespace halfshade::reading
