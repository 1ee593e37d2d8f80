#include "io/read/read_ply.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace halfshade::reading::ply {

Values::Values(const std::filesystem::path& file, std::string_view bytes, const Header& header)
    : file_(file),
      data_(bytes.substr(header.size)),
      encoding_(header.encoding),
      line_(header.lines + 1) {}

void Values::ends_early() const {
  fail(file_, 0, fmt::format("the file ends within {} {}", element_, index_));
}

void Values::require(long long count, std::size_t least_size, std::string_view what) const {
  // The last character of a text needs no space after it.
  if (count < 0 || static_cast<std::size_t>(count) > (data_.size() + 1) / least_size)
    fail(file_, line(),
         fmt::format("there cannot be {} {} in the {} bytes that are left; the file "
                     "is cut short, or the number is wrong",
                     count, what, data_.size()));
}

void Values::skip_spaces() {
  if (encoding_ != Encoding::ascii) return;
  std::size_t n = 0;
  for (; n < data_.size(); ++n) {
    const char c = data_[n];
    if (c == '\n' || (c == '\r' && !data_.substr(n + 1).starts_with('\n')))
      ++line_;
    else if (c != ' ' && c != '\t' && c != '\r')
      break;
  }
  data_.remove_prefix(n);
}

int Values::next_line() {
  skip_spaces();
  return line();
}

bool Values::at_end() {
  skip_spaces();
  return data_.empty();
}

std::string_view Values::next_word() {
  skip_spaces();
  if (data_.empty()) ends_early();
  const std::size_t end = std::min(data_.find_first_of(" \t\r\n"), data_.size());
  const std::string_view word = data_.substr(0, end);
  data_.remove_prefix(end);
  return word;
}

template <typename Bits>
Bits Values::next_bits() {
  if (data_.size() < sizeof(Bits)) ends_early();
  std::array<char, sizeof(Bits)> bytes;
  std::memcpy(bytes.data(), data_.data(), sizeof(Bits));
  data_.remove_prefix(sizeof(Bits));
  constexpr bool native_little = std::endian::native == std::endian::little;
  if ((encoding_ == Encoding::little_endian) != native_little)
    std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Bits>(bytes);
}

long long Values::binary_integer(Type type) {
  switch (type) {
    case Type::int8:
      return static_cast<std::int8_t>(next_bits<std::uint8_t>());
    case Type::uint8:
      return next_bits<std::uint8_t>();
    case Type::int16:
      return static_cast<std::int16_t>(next_bits<std::uint16_t>());
    case Type::uint16:
      return next_bits<std::uint16_t>();
    case Type::int32:
      return static_cast<std::int32_t>(next_bits<std::uint32_t>());
    default:
      return next_bits<std::uint32_t>();
  }
}

double Values::real(Type type) {
  if (encoding_ == Encoding::ascii) {
    const std::string_view word = next_word();
    return number(word, file_, line_);
  }
  if (type == Type::float32)
    return static_cast<double>(std::bit_cast<float>(next_bits<std::uint32_t>()));
  if (type == Type::float64) return std::bit_cast<double>(next_bits<std::uint64_t>());
  return static_cast<double>(binary_integer(type));
}

long long Values::integer(Type type) {
  if (encoding_ != Encoding::ascii) return binary_integer(type);
  const std::string_view word = next_word();
  const std::optional<long long> value = parse_integer(word);
  if (!value) fail(file_, line_, fmt::format("{} is not an integer", in_quotes(word)));
  return *value;
}

}  // namespace halfshade::reading::ply
