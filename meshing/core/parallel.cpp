#include "meshing/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

namespace halfshade {

bool parallel_for(std::size_t count, const std::function<void(std::size_t)>& body,
                  const Progress& progress, std::string_view stage) {
  std::atomic<std::size_t> done{0};
  std::atomic<bool> complete{true};
  std::mutex reporting;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count), [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          if (progress.stopped()) {
            complete = false;
            return;
          }
          body(i);
        }
        done += range.size();
        if (const std::unique_lock lock(reporting, std::try_to_lock); lock && progress.report)
          progress(stage, static_cast<double>(done) / static_cast<double>(count));
      });
  return complete;
}

}  // namespace halfshade
