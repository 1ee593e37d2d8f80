// Meshes of Gmsh, formats 2.2 and 4.1 as its manual lays them out in binary: the names of sections
// and physical groups are lines of text, the rest is numbers in the byte order of who wrote them.

#include "io/read/msh_mesh.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace halfshade::reading {
namespace {

/// Lines and numbers, one after the other.
class MshBytes {
 public:
  MshBytes(const std::filesystem::path& file, std::string_view bytes)
      : file_(file), bytes_(bytes) {}

  /// The next line that has something in it; false at the end.
  bool next_line() {
    do {
      if (at_ >= bytes_.size()) return false;
      const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
      line_ = trimmed(bytes_.substr(at_, end - at_));
      if (line_.ends_with('\r')) line_ = trimmed(line_.substr(0, line_.size() - 1));
      at_ = std::min(end + 1, bytes_.size());
    } while (line_.empty());
    return true;
  }

  std::string_view need_line(const std::string& what) {
    if (!next_line()) fail(file_, 0, fmt::format("the file ends before {}", what));
    return line_;
  }

  void expect_line(const std::string& name) {
    if (need_line(name) != name)
      fail(file_, 0, fmt::format("{} is expected, not {}", name, in_quotes(line_)));
  }

  /// Moves behind the line that ends a section.
  void skip_to(const std::string& name) {
    const std::size_t found = bytes_.find("\n" + name, at_ > 0 ? at_ - 1 : 0);
    if (found == std::string_view::npos)
      fail(file_, 0, fmt::format("the file ends before {}", name));
    at_ = found + 1;
    next_line();
  }

  std::string_view line() const { return line_; }
  void set_swapped(bool swapped) { is_swapped_ = swapped; }

  long long whole_4() { return read<std::int32_t>(); }

  /// Numbers that count or name something are without a sign.
  long long whole_8() {
    const auto value = read<std::uint64_t>();
    if (value > INT64_MAX) fail(file_, 0, fmt::format("{} is not a number of things", value));
    return static_cast<long long>(value);
  }

  /// How many things follow that take so many bytes each, at least.
  long long count_4(std::size_t size) { return checked(whole_4(), size); }
  long long count_8(std::size_t size) { return checked(whole_8(), size); }
  long long checked(long long count, std::size_t size) const {
    if (count < 0) fail(file_, 0, fmt::format("{} is not a number of things", count));
    if (static_cast<unsigned long long>(count) > (bytes_.size() - at_) / size)
      fail(file_, 0,
           fmt::format("the file is cut short: {} things of {} bytes or more are to follow, but "
                       "only {} bytes do",
                       count, size, bytes_.size() - at_));
    return count;
  }

  double real() { return read<double>(); }
  Vec3 point() {
    const double x = real(), y = real(), z = real();
    return {x, y, z};
  }
  void skip(long long count, std::size_t size) {
    at_ += static_cast<std::size_t>(checked(count, size)) * size;
  }

 private:
  template <class Value>
  Value read() {
    std::array<char, sizeof(Value)> raw;
    checked(1, raw.size());
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), raw.size(), raw.begin());
    at_ += raw.size();
    if (is_swapped_) std::reverse(raw.begin(), raw.end());
    Value value;
    std::memcpy(&value, raw.data(), raw.size());
    return value;
  }

  std::filesystem::path file_;
  std::string_view bytes_, line_;
  std::size_t at_ = 0;
  bool is_swapped_ = false;
};

class BinaryMshReader {
 public:
  BinaryMshReader(const std::filesystem::path& file, std::string_view bytes)
      : file_(file), in_(file, bytes), mesh_(file) {}

  SceneDraft read() {
    format();
    while (in_.next_line()) section(std::string(in_.line()));
    return mesh_.finish();
  }

 private:
  /// Format and kind of file are known to be fine; a 1 tells the order of bytes.
  void format() {
    in_.expect_line("$MeshFormat");
    std::vector<std::string_view> words;
    split(in_.need_line("its format"), words);
    is_new_ = words[0] == "4.1";
    if (words.size() < 3 || words[2] != "8")
      fail(file_, 0,
           fmt::format("the format is {}; only numbers of 8 bytes can be read",
                       in_quotes(in_.line())));
    constexpr long long swapped_one = 1 << 24;
    const long long one = in_.whole_4();
    in_.set_swapped(one == swapped_one);
    if (one != 1 && one != swapped_one)
      fail(file_, 0, fmt::format("the number that tells the order of bytes is {}, not 1", one));
    in_.expect_line("$EndMeshFormat");
  }

  void section(const std::string& name) {
    const std::string last = name.starts_with('$') ? "$End" + name.substr(1) : "";
    if (name == "$PhysicalNames") {
      names();
    } else if (name == "$Nodes") {
      is_new_ ? node_blocks() : nodes();
    } else if (name == "$Elements") {
      is_new_ ? element_blocks() : elements();
    } else if (name == "$Entities" && is_new_) {
      entities();
    } else if (name == "$PartitionedEntities") {
      fail(file_, 0, "meshes that are cut into partitions cannot be read; save it without them");
    } else if (last.empty()) {
      fail(file_, 0, fmt::format("{} stands where a section ($…) should begin", in_quotes(name)));
    } else {
      return in_.skip_to(last);
    }
    in_.expect_line(last);
  }

  /// The line that says how many things of so many bytes follow.
  long long count_line(const std::string& what, std::size_t size) {
    const std::string_view text = in_.need_line(what);
    const std::optional<long long> count = parse_integer(text);
    if (!count) fail(file_, 0, fmt::format("{} is not {}", in_quotes(text), what));
    return in_.checked(*count, size);
  }

  void names() {
    for (long long n = count_line("the number of names", 1); n > 0; --n)
      mesh_.add_name(in_.need_line("a physical name"), 0);
  }

  void nodes() {
    for (long long n = count_line("the number of nodes", 28); n > 0; --n) {
      const long long tag = in_.whole_4();
      mesh_.add_node(tag, in_.point(), 0);
    }
  }

  void node_blocks() {
    const long long blocks = in_.count_8(20);
    in_.skip(3, 8);
    for (long long b = 0; b < blocks; ++b) {
      const long long dimension = in_.whole_4();
      in_.skip(1, 4);
      const bool is_parametric = in_.whole_4() != 0;
      tags_.clear();
      for (long long n = in_.count_8(32); n > 0; --n) tags_.push_back(in_.whole_8());
      for (const long long tag : tags_) {
        mesh_.add_node(tag, in_.point(), 0);
        if (is_parametric) in_.skip(std::clamp(dimension, 0LL, 3LL), 8);
      }
    }
  }

  void entities() {
    std::array<long long, 4> counts{};
    for (long long& count : counts) count = in_.whole_8();
    for (std::size_t dimension = 0; dimension < 4; ++dimension)
      for (long long n = in_.checked(counts[dimension], 36); n > 0; --n) {
        const long long tag = in_.whole_4();
        in_.skip(dimension == 0 ? 3 : 6, 8);
        tags_.clear();
        for (long long k = in_.count_8(4); k > 0; --k) tags_.push_back(in_.whole_4());
        if (dimension == 2) mesh_.add_surface(tag, tags_, 0);
        if (dimension > 0) in_.skip(in_.count_8(4), 4);
      }
  }

  void elements() {
    long long left = count_line("the number of elements", 4);
    while (left > 0) {
      const long long type = in_.whole_4(), count = in_.whole_4(), tags = in_.whole_4();
      if (count < 1 || count > left || tags < 0)
        fail(file_, 0,
             fmt::format("{} elements with {} tags cannot follow where {} are left", count, tags,
                         left));
      for (long long n = 0; n < count; ++n) {
        const bool is_face = mesh_.is_face(type, 0);
        const long long element = in_.whole_4();
        const long long group = tags > 0 ? in_.whole_4() : 0;
        in_.skip(std::max(tags - 1, 0LL), 4);
        tags_.clear();
        for (int k = msh_nodes(type); k > 0; --k) tags_.push_back(in_.whole_4());
        if (is_face) mesh_.add_face(element, tags_, group, 0);
      }
      left -= count;
    }
  }

  void element_blocks() {
    const long long blocks = in_.count_8(20);
    in_.skip(3, 8);
    for (long long b = 0; b < blocks; ++b) {
      in_.skip(1, 4);
      const long long entity = in_.whole_4(), type = in_.whole_4();
      for (long long n = in_.count_8(16); n > 0; --n) {
        const bool is_face = mesh_.is_face(type, 0);
        const long long element = in_.whole_8();
        tags_.clear();
        for (int k = msh_nodes(type); k > 0; --k) tags_.push_back(in_.whole_8());
        if (is_face) mesh_.add_face(element, tags_, mesh_.group_of(entity), 0);
      }
    }
  }

  std::filesystem::path file_;
  MshBytes in_;
  MshMesh mesh_;
  std::vector<long long> tags_;
  bool is_new_ = false;  ///< 4.1, not 2
};

}  // namespace

SceneDraft read_binary_msh(const std::filesystem::path& path, std::string_view bytes) {
  return BinaryMshReader(path, bytes).read();
}

}  // namespace halfshade::reading
