#pragma once

#include "meshing/core/progress.h"

#include <cstddef>
#include <functional>
#include <string_view>

namespace halfshade {

/// Runs `body(i)` for every i in [0, count) on the threads of TBB's current arena, in any order.
/// Reports progress under the name `stage`. `body` must write only to places that belong to i, so
/// that the result does not depend on the number of threads; it may throw, and the first exception
/// is passed on. Returns false if `progress` was stopped before every i had run.
bool parallel_for(std::size_t count, const std::function<void(std::size_t)>& body,
                  const Progress& progress = {}, std::string_view stage = {});

}  // namespace halfshade
