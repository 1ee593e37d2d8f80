#pragma once

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

/// Counts calls of operator new. Include in one source file of a test program only. Sanitizers
/// bring their own operator new, so nothing is counted with them.
namespace halfshade::test {

inline std::atomic<std::size_t> allocation_count{0};
inline std::size_t allocations() { return allocation_count; }

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool counts_allocations = false;
#else
inline constexpr bool counts_allocations = true;
#endif

inline void* counted(std::size_t size) {
  ++allocation_count;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}

}  // namespace halfshade::test

#ifndef __SANITIZE_ADDRESS__
#if defined(__GNUC__) && !defined(__clang__)
// Where GCC inlines the one but not the other it sees memory of `new` given to `free`.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
void* operator new(std::size_t size) { return halfshade::test::counted(size); }
void* operator new[](std::size_t size) { return halfshade::test::counted(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
#endif
