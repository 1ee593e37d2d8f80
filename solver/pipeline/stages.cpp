#include "solver/pipeline/stages.h"

#include "meshing/core/free_memory.h"

#include <utility>

namespace halfshade {
namespace {

constexpr double takes_long = 1;  // second

}  // namespace

void Stages::end(StageReport report) {
  if (report.seconds > takes_long) return_free_memory();
  reports_.push_back(std::move(report));
}

}  // namespace halfshade
