#include "io/read/read_text.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iostream>
#include <new>

namespace halfshade::reading {
namespace {

constexpr std::string_view spaces = " \t\v\f";

std::ifstream open(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail(path, 0, "there is no such file");
  if (status.type() == fs::file_type::directory) fail(path, 0, "this is a directory, not a file");
  if (status.type() != fs::file_type::regular && status.type() != fs::file_type::fifo)
    fail(path, 0, error ? "cannot be read: " + error.message() : "this is not a regular file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(path, 0, "cannot be opened for reading");
  return stream;
}

std::string_view without_comment(std::string_view line) {
  for (std::size_t at = line.find('#'); at != line.npos; at = line.find('#', at + 1))
    if (at == 0 || spaces.find(line[at - 1]) != spaces.npos) return line.substr(0, at);
  return line;
}

std::string read_all(std::istream& stream, const std::filesystem::path& path) {
  std::string bytes;
  try {
    std::size_t size = 0;
    while (stream) {
      const std::size_t chunk = std::max<std::size_t>(size, 1U << 14U);
      bytes.resize(size + chunk);
      stream.read(bytes.data() + size, static_cast<std::streamsize>(chunk));
      size += static_cast<std::size_t>(stream.gcount());
    }
    bytes.resize(size);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::too_large, path.string(), "the file does not fit into memory");
  }
  if (stream.bad()) fail(path, 0, "reading stopped before the end of the file");
  if (bytes.empty()) fail(path, 0, "the file is empty");
  return bytes;
}

}  // namespace

std::string place(const std::filesystem::path& path, int line) {
  // A file may name another at any length.
  constexpr std::size_t longest = 400;
  const std::string whole = path.string();
  std::size_t first = whole.size() > longest ? whole.size() - longest : 0;
  // Not in the middle of a character of UTF-8.
  while (first > 0 && first < whole.size() && (whole[first] & 0xC0) == 0x80) ++first;
  const std::string name = first > 0 ? "…" + whole.substr(first) : whole;
  return line > 0 ? fmt::format("{}:{}", name, line) : name;
}

void fail(const std::filesystem::path& path, int line, const std::string& sentence) {
  throw Error(ErrorCode::invalid_input, place(path, line), sentence);
}

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream stream = open(path);
  return read_all(stream, path);
}

std::string read_standard_input() { return read_all(std::cin, "standard input"); }

void require_readable(const std::filesystem::path& path) {
  std::ifstream stream = open(path);
  if (stream.get() == std::ifstream::traits_type::eof()) fail(path, 0, "the file is empty");
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) {
    const auto code = static_cast<unsigned char>(c);
    result += code < 0x20 || code == 0x7f ? '?' : c;
  }
  return result + (text.size() > longest ? "…'" : "'");
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  if (names.empty()) return "none";
  std::string result;
  for (std::size_t i = 0; i < names.size() && i < most; ++i)
    result += (i > 0 ? ", " : "") + in_quotes(names[i]);
  if (names.size() > most) result += fmt::format(" and {} more", names.size() - most);
  return result;
}

std::optional<double> parse_double(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  double value = 0;
  auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::result_out_of_range) {
    // Numbers too small for a double are zero for our purpose; a wider type tells them apart from
    // numbers that are too large.
    long double wide = 0;
    const auto again = std::from_chars(word.data(), end, wide);
    if (again.ec != std::errc() || std::abs(wide) > 1) return std::nullopt;
    value = static_cast<double>(wide);
    stop = again.ptr;
    error = again.ec;
  }
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::optional<long long> parse_integer(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  long long value = 0;
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

double number(std::string_view word, const std::filesystem::path& path, int line) {
  const std::optional<double> value = parse_double(word);
  if (value) return *value;
  const bool comma = word.find(',') != word.npos;
  fail(path, line,
       fmt::format("{} is not a number{}", in_quotes(word),
                   comma ? "; decimals are written with a point" : " that a double can hold"));
}

double finite_number(std::string_view word, const std::filesystem::path& path, int line) {
  const double value = number(word, path, line);
  if (!std::isfinite(value))
    fail(path, line, fmt::format("a coordinate is {}; it must be finite", in_quotes(word)));
  return value;
}

void split(std::string_view text, std::vector<std::string_view>& words) {
  words.clear();
  std::size_t at = text.find_first_not_of(spaces);
  while (at != text.npos) {
    const std::size_t end = std::min(text.find_first_of(spaces, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(spaces, end);
  }
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(spaces);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(spaces) - first + 1);
}

LineReader::LineReader(std::string_view bytes, Continuation continuation)
    : rest_(bytes), continuation_(continuation) {
  if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
}

std::string_view LineReader::next_raw() {
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end);
  rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, rest_.size()));
  ++lines_read_;
  return line;
}

bool LineReader::next() {
  while (!rest_.empty()) {
    const std::string_view raw = next_raw();
    line_ = lines_read_;
    text_ = trimmed(without_comment(raw));
    // A comment that ends with a backslash, such as a folder's name, does not continue.
    if (continuation_ == Continuation::backslash && text_.ends_with('\\') &&
        trimmed(raw).ends_with('\\')) {
      joined_.clear();
      while (text_.ends_with('\\')) {
        joined_.append(text_.substr(0, text_.size() - 1)).push_back(' ');
        text_ = rest_.empty() ? std::string_view() : trimmed(without_comment(next_raw()));
      }
      joined_.append(text_);
      text_ = trimmed(joined_);
    }
    if (!text_.empty()) return true;
  }
  return false;
}

}  // namespace halfshade::reading
