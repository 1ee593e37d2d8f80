#pragma once

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

/// Damaged files for readers. Every mutation follows from the state of the generator.
namespace halfshade::test {

/// What numbers and lines may become: limits of integers and doubles, none, and what has a meaning.
inline const std::vector<std::string>& hard_cases() {
  static const std::vector<std::string> cases = {"-1",
                                                 "0",
                                                 "-0",
                                                 "1e400",
                                                 "1e999",
                                                 "nan",
                                                 "inf",
                                                 "1e-999",
                                                 "2147483648",
                                                 "4294967295",
                                                 "99999999999999999999",
                                                 "\n",
                                                 "\\\n",
                                                 "/",
                                                 "#",
                                                 std::string(1, '\0'),
                                                 "\xFF\xFE",
                                                 "-",
                                                 "+",
                                                 ".",
                                                 "{",
                                                 "[",
                                                 "\"",
                                                 ",",
                                                 "null"};
  return cases;
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  /// One to three changes.
  std::string operator()(std::string bytes) {
    for (std::size_t change = 0, count = 1 + below(3); change < count; ++change) switch (below(8)) {
        case 0:
          bytes.resize(below(bytes.size() + 1));
          break;
        case 1:
          replace_some(bytes, "");
          break;
        case 2:
          bytes.insert(below(bytes.size() + 1), bytes.substr(below(bytes.size() + 1), below(20)));
          break;
        case 3:
          replace_some(bytes, hard_cases()[below(hard_cases().size())]);
          break;
        case 4:
          replace_number(bytes);
          break;
        case 5:
          repeat_line(bytes);
          break;
        default:
          change_byte(bytes);
      }
    return bytes;
  }

 private:
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  void replace_some(std::string& bytes, const std::string& by) {
    const std::size_t at = below(bytes.size() + 1);
    bytes.replace(at, below(std::min<std::size_t>(8, bytes.size() - at) + 1), by);
  }

  void replace_number(std::string& bytes) {
    const std::size_t from = bytes.find_first_of("0123456789", below(bytes.size() + 1));
    if (from == std::string::npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789.e-", from), bytes.size());
    bytes.replace(from, end - from, hard_cases()[below(hard_cases().size())]);
  }

  /// Many times, for what grows with each.
  void repeat_line(std::string& bytes) {
    const std::size_t in = below(bytes.size() + 1), before = bytes.rfind('\n', in);
    const std::size_t from = before == std::string::npos ? 0 : before + 1;
    const std::size_t end = std::min(bytes.find('\n', from), bytes.size());
    const std::string line = bytes.substr(from, end - from) + "\n";
    for (std::size_t k = 0, count = 1 + below(50); k < count; ++k) bytes.insert(from, line);
  }

  void change_byte(std::string& bytes) {
    if (bytes.empty()) return;
    char& byte = bytes[below(bytes.size())];
    byte = static_cast<char>(below(2) == 0 ? below(256)
                                           : static_cast<unsigned char>(byte) ^ (1U << below(8)));
  }

  std::mt19937 random_;
};

}  // namespace halfshade::test
