#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The two halves of a PLY file: a header that says what comes, and the values.
namespace halfshade::reading::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct TypeName {
  std::string_view name, alias;
  std::size_t size;
};

/// In the order of Type.
inline constexpr std::array<TypeName, 8> type_names = {{{"char", "int8", 1},
                                                        {"uchar", "uint8", 1},
                                                        {"short", "int16", 2},
                                                        {"ushort", "uint16", 2},
                                                        {"int", "int32", 4},
                                                        {"uint", "uint32", 4},
                                                        {"float", "float32", 4},
                                                        {"double", "float64", 8}}};

inline std::size_t size_of(Type type) { return type_names[static_cast<std::size_t>(type)].size; }
inline bool is_real(Type type) { return type == Type::float32 || type == Type::float64; }

struct Property {
  std::string name;
  Type type = Type::float32;
  std::optional<Type> count_type;  ///< set for lists
};

struct Element {
  std::string name;
  long long count = 0;
  std::vector<Property> properties;
};

enum class Encoding { ascii, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes before the data
  int lines = 0;
};

/// Throws Error(invalid_input) with file and line.
Header read_header(const std::filesystem::path& file, std::string_view bytes);

/// The values of the data section, one after another.
class Values {
 public:
  /// `bytes` is the whole file and must outlive this.
  Values(const std::filesystem::path& file, std::string_view bytes, const Header& header);

  double real(Type type);

  /// Precondition: `type` is an integer type.
  long long integer(Type type);

  /// Fails unless `count` things of at least `least_size` bytes each can follow; `what` names them.
  void require(long long count, std::size_t least_size, std::string_view what) const;

  /// Bytes that one value takes at least.
  std::size_t least_size(Type type) const {
    return encoding_ == Encoding::ascii ? 2 : size_of(type);
  }

  /// Says what is being read, for messages: "vertex", 7.
  void set_element(std::string_view name, long long index) {
    element_ = name;
    index_ = index;
  }

  /// The line of the value read last, and of the next one; 0 in binary files.
  int line() const { return encoding_ == Encoding::ascii ? line_ : 0; }
  int next_line();

  /// True if no value is left.
  bool at_end();

 private:
  void skip_spaces();
  std::string_view next_word();
  long long binary_integer(Type type);
  template <typename Bits>
  Bits next_bits();
  [[noreturn]] void ends_early() const;

  std::filesystem::path file_;
  std::string_view data_;
  Encoding encoding_;
  int line_;
  std::string_view element_;
  long long index_ = 0;
};

}  // namespace halfshade::reading::ply
