#pragma once

namespace halfshade {

/// Gives the system what was freed: glibc's allocator keeps it for the thread that freed it, so
/// that a program of several stages and threads grows to the sum of what each of them takes.
/// Elsewhere it does nothing.
void return_free_memory();

}  // namespace halfshade
