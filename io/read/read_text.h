#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Text and numbers out of files, independent of the locale.
namespace halfshade::reading {

/// The whole file. Throws Error(invalid_input) if it is missing, a directory, unreadable or empty,
/// Error(too_large) if it does not fit into memory.
std::string read_bytes(const std::filesystem::path& path);

/// All of the standard input. Throws as read_bytes.
std::string read_standard_input();

/// The same checks without keeping the content.
void require_readable(const std::filesystem::path& path);

/// Throws Error(invalid_input) at "file:line", or at "file" if `line` is 0.
[[noreturn]] void fail(const std::filesystem::path& path, int line, const std::string& sentence);

/// "file:line", or "file" if `line` is 0; the end of the file's name if that is very long.
std::string place(const std::filesystem::path& path, int line);

/// Text of a file as it can stand in a message: in quotes, shortened, without control characters.
std::string in_quotes(std::string_view text);

/// "'a', 'b', 'c' and 4 more"; "none" if empty.
std::string listed(const std::vector<std::string>& names);

/// The number that all of `word` is; empty if it is none or too large for a double. Accepts a
/// leading + and the words nan and inf.
std::optional<double> parse_double(std::string_view word);
std::optional<long long> parse_integer(std::string_view word);

/// A coordinate or colour channel; fails with a sentence that says what is wrong with `word`.
double number(std::string_view word, const std::filesystem::path& path, int line);
double finite_number(std::string_view word, const std::filesystem::path& path, int line);

/// Cuts a text into words at spaces and tabs; reuses `words`.
void split(std::string_view text, std::vector<std::string_view>& words);

std::string_view trimmed(std::string_view text);

/// The text in small letters, of A to Z.
std::string lower(std::string_view text);

/// Goes through a text line by line. Lines end with \n, \r\n or \r. Comments, which start with # at
/// the start of a line or after a space, are cut off, spaces at both ends, too, and lines without
/// anything left are skipped.
class LineReader {
 public:
  enum class Continuation { none, backslash };

  /// `bytes` must outlive the reader. Skips a UTF-8 byte order mark.
  explicit LineReader(std::string_view bytes, Continuation continuation = Continuation::none);

  /// Moves to the next line; false at the end.
  bool next();

  std::string_view text() const { return text_; }
  /// Of the present line, counted from 1; where a continued line starts.
  int line() const { return line_; }

 private:
  std::string_view next_raw();

  std::string_view rest_;
  Continuation continuation_;
  std::string joined_;
  std::string_view text_;
  int line_ = 0;
  int lines_read_ = 0;
};

}  // namespace halfshade::reading
