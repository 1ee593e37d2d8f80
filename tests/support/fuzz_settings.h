#pragma once

#include <cstdlib>

/// Fuzz tests run longer, and otherwise, as the environment says.
namespace halfshade::test {

inline int fuzz_setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : otherwise;
}

/// HALFSHADE_FUZZ_SECONDS: what a test takes at least; 0 if not given.
inline int fuzz_seconds() { return fuzz_setting("HALFSHADE_FUZZ_SECONDS", 0); }

/// HALFSHADE_FUZZ_SEED.
inline int fuzz_seed(int otherwise) { return fuzz_setting("HALFSHADE_FUZZ_SEED", otherwise); }

}  // namespace halfshade::test
