#include "io/read/read_ply.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade::reading::ply {
namespace {

/// Reads the header, whose lines end like its first one.
class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& file, std::string_view bytes)
      : file_(file), bytes_(bytes) {}

  Header read() {
    if (lower(bytes_.substr(0, 3)) != "ply" || bytes_.find_first_of("\r\n") != 3)
      fail(file_, 1, "the first line of a PLY file must be 'ply'");
    ending_ = bytes_.substr(3).starts_with("\r\n") ? "\r\n" : bytes_.substr(3, 1);
    next();
    bool has_format = false;
    while (next()) {
      split(text_, words_);
      const std::string keyword = words_.empty() ? "comment" : lower(words_[0]);
      if (keyword == "comment" || keyword == "obj_info") continue;
      if (keyword == "end_header") {
        if (!has_format) fail(file_, header_.lines, "the header ends without a format");
        return header_;
      }
      if (keyword == "format") {
        format();
        has_format = true;
      } else if (keyword == "element") {
        element();
      } else if (keyword == "property") {
        property();
      } else {
        fail(file_, header_.lines,
             fmt::format("{} is not a keyword of a header", in_quotes(words_[0])));
      }
    }
    fail(file_, header_.lines, "the file ends within its header");
  }

 private:
  bool next() {
    const std::string_view rest = bytes_.substr(header_.size);
    if (rest.empty()) return false;
    const std::size_t end = std::min(rest.find(ending_), rest.size());
    text_ = rest.substr(0, end);
    header_.size += std::min(end + ending_.size(), rest.size());
    ++header_.lines;
    return true;
  }

  void format() {
    const std::string name = words_.size() > 1 ? lower(words_[1]) : "";
    if (name == "ascii") {
      header_.encoding = Encoding::ascii;
    } else if (name == "binary_little_endian") {
      header_.encoding = Encoding::little_endian;
    } else if (name == "binary_big_endian") {
      header_.encoding = Encoding::big_endian;
    } else {
      fail(file_, header_.lines,
           fmt::format("format {} is not known; there are ascii, binary_little_endian and "
                       "binary_big_endian",
                       in_quotes(name)));
    }
  }

  void element() {
    const std::optional<long long> count =
        words_.size() == 3 ? parse_integer(words_[2]) : std::nullopt;
    if (!count || *count < 0)
      fail(file_, header_.lines,
           fmt::format("{} does not give a name and a number of elements", in_quotes(text_)));
    header_.elements.push_back({std::string(words_[1]), *count, {}});
  }

  void property() {
    if (header_.elements.empty()) fail(file_, header_.lines, "a property comes before any element");
    Property property;
    if (words_.size() == 5 && lower(words_[1]) == "list") {
      property.count_type = type(words_[2]);
      if (is_real(*property.count_type))
        fail(file_, header_.lines, "the length of a list cannot be a floating-point number");
      property.type = type(words_[3]);
    } else if (words_.size() == 3) {
      property.type = type(words_[1]);
    } else {
      fail(file_, header_.lines,
           fmt::format("{} does not give a type and a name", in_quotes(text_)));
    }
    property.name = words_.back();
    header_.elements.back().properties.push_back(std::move(property));
  }

  Type type(std::string_view name) const {
    const std::string small = lower(name);
    for (std::size_t i = 0; i < type_names.size(); ++i)
      if (small == type_names[i].name || small == type_names[i].alias) return static_cast<Type>(i);
    fail(file_, header_.lines, fmt::format("{} is not a type of PLY files", in_quotes(name)));
  }

  std::filesystem::path file_;
  std::string_view bytes_, ending_, text_;
  std::vector<std::string_view> words_;
  Header header_;
};

}  // namespace

Header read_header(const std::filesystem::path& file, std::string_view bytes) {
  return HeaderReader(file, bytes).read();
}

}  // namespace halfshade::reading::ply
