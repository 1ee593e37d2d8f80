// Meshes of Gmsh (Geuzaine and Remacle 2009), formats 2 and 4.1 as text: triangles and
// quadrangles, with physical groups as groups.

#include "io/read/read_formats.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

namespace halfshade::reading {
namespace {

/// What becomes of elements of a type.
enum class ElementUse { face, none, volume, curved, unknown };

ElementUse use_of(long long type) {
  const auto is_one_of = [type](std::initializer_list<long long> types) {
    return std::find(types.begin(), types.end(), type) != types.end();
  };
  if (is_one_of({2, 3})) return ElementUse::face;
  if (is_one_of({1, 8, 15, 26, 27, 28})) return ElementUse::none;  // lines and points
  if (is_one_of({4, 5, 6, 7, 11, 12, 13, 14, 17, 18, 19, 29, 30, 31, 92, 93}))
    return ElementUse::volume;
  if (is_one_of({9, 10, 16, 20, 21, 22, 23, 24, 25, 36, 37})) return ElementUse::curved;
  return ElementUse::unknown;
}

class MshReader {
 public:
  explicit MshReader(const std::filesystem::path& file)
      : file_(file), bytes_(read_bytes(file)), lines_(bytes_) {
    draft_.scene.source = file.string();
  }

  SceneDraft read() {
    next("$MeshFormat");
    if (words_[0] != "$MeshFormat")
      reject("a .msh file begins with $MeshFormat; others, also of format 1, cannot be read");
    format();
    while (lines_.next()) {
      split(lines_.text(), words_);
      section();
    }
    if (volumes_ > 0)
      draft_.warnings.push_back(fmt::format(
          "{}: {} volume elements are not used; faces are triangles and quadrangles of the file",
          file_.string(), volumes_));
    return std::move(draft_);
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

  void format() {
    next("its format", 2);
    const std::string_view version = words_[0];
    is_new_ = version == "4.1";
    if (!is_new_ && version != "2" && !version.starts_with("2."))
      reject(fmt::format("format {} cannot be read; save it as format 4.1 or 2.2",
                         in_quotes(version)));
    if (words_[1] != "0")
      reject("binary .msh files cannot be read; save it as text (Mesh.Binary = 0)");
    end("$EndMeshFormat");
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

  /// "dimension tag "name""
  void names() {
    next("the number of names");
    for (long long n = count(0); n > 0; --n) {
      next("a physical name", 3);
      const long long tag = whole(1);
      const std::string_view text = lines_.text();
      const std::size_t first = text.find('"'), last = text.rfind('"');
      if (first == last) reject("the name of a physical group stands in quotes");
      if (whole(0) == 2 && last > first + 1)
        draft_.named_groups.insert(names_[tag] = text.substr(first + 1, last - first - 1));
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
    std::vector<Vec3>& vertices = draft_.scene.vertices;
    if (!nodes_.try_emplace(tag, static_cast<long long>(vertices.size())).second)
      reject(fmt::format("node {} is there twice", tag));
    vertices.emplace_back(finite_number(words_[first_word], file_, lines_.line()),
                          finite_number(words_[first_word + 1], file_, lines_.line()),
                          finite_number(words_[first_word + 2], file_, lines_.line()));
  }

  /// Which physical group a surface is in; the first, if there are several.
  void entities() {
    next("the numbers of entities", 4);
    const std::array<long long, 4> counts{count(0), count(1), count(2), count(3)};
    for (std::size_t dimension = 0; dimension < 4; ++dimension)
      for (long long n = counts[dimension]; n > 0; --n) {
        next("an entity", dimension == 0 ? 5 : 8);
        if (dimension != 2 || count(7) == 0) continue;
        if (words_.size() < 9) reject("the physical groups of a surface are expected here");
        physical_[whole(0)] = group_tag(8);
        if (count(7) > 1)
          draft_.warnings.push_back(
              fmt::format("{}: surface {} is in {} physical groups; the first one counts",
                          place(file_, lines_.line()), whole(0), count(7)));
      }
    end("$EndEntities");
  }

  /// "number type tags tag… node…", the first tag the physical group.
  void elements() {
    next("the number of elements");
    for (long long n = count(0); n > 0; --n) {
      next("an element", 3);
      if (!is_face(whole(1))) continue;
      const long long tags = count(2);
      const std::size_t size = whole(1) == 2 ? 3 : 4;
      if (tags > static_cast<long long>(words_.size()) ||
          words_.size() < 3 + static_cast<std::size_t>(tags) + size)
        reject(fmt::format("element {} has {} words; {} tags and {} nodes are more", words_[0],
                           words_.size(), tags, size));
      add_face(tags > 0 ? group_tag(3) : 0, 3 + static_cast<std::size_t>(tags), size);
    }
    end("$EndElements");
  }

  void element_blocks() {
    next("the numbers of elements", 4);
    for (long long blocks = count(0); blocks > 0; --blocks) {
      next("a block of elements", 4);
      const long long type = whole(2);
      const auto physical = physical_.find(whole(1));
      const long long group = physical == physical_.end() ? 0 : physical->second;
      for (long long n = count(3); n > 0; --n) {
        next("an element", type == 3 ? 5 : type == 2 ? 4 : 1);
        if (is_face(type)) add_face(group, 1, type == 2 ? 3 : 4);
      }
    }
    end("$EndElements");
  }

  bool is_face(long long type) {
    switch (use_of(type)) {
      case ElementUse::face:
        return true;
      case ElementUse::none:
        return false;
      case ElementUse::volume:
        ++volumes_;
        return false;
      case ElementUse::curved:
        reject(
            "triangles and quadrangles of a higher order cannot be read; mesh with "
            "Mesh.ElementOrder = 1");
      case ElementUse::unknown:
        break;
    }
    reject(fmt::format("elements of type {} are not known", type));
  }

  /// `first_word` has the first of the nodes.
  void add_face(long long group, std::size_t first_word, std::size_t size) {
    corners_.clear();
    for (std::size_t k = 0; k < size; ++k) {
      const auto node = nodes_.find(whole(first_word + k));
      if (node == nodes_.end())
        reject(fmt::format("element {} names node {}, which is not there", words_[0],
                           words_[first_word + k]));
      corners_.push_back(node->second);
    }
    reading::add_face(draft_, corners_, lines_.line(), group_name(group));
  }

  std::string group_name(long long tag) const {
    if (tag == 0) return default_name;
    const auto name = names_.find(tag);
    return name != names_.end() ? name->second : fmt::format("physical {}", tag);
  }

  long long group_tag(std::size_t word) const {
    const long long tag = whole(word);
    if (tag < 0)
      reject(
          fmt::format("a surface is in the physical group {} the other way round; turn the "
                      "surface instead",
                      tag));
    return tag;
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
  SceneDraft draft_;
  std::vector<std::string_view> words_;
  std::vector<long long> corners_;
  bool is_new_ = false;                             ///< 4.1, not 2
  std::map<long long, std::string> names_;          ///< of physical surfaces
  std::map<long long, long long> physical_;         ///< surface → its physical group
  std::unordered_map<long long, long long> nodes_;  ///< tag → vertex
  long long volumes_ = 0;
};

}  // namespace

SceneDraft read_msh(const std::filesystem::path& path) { return MshReader(path).read(); }

}  // namespace halfshade::reading
