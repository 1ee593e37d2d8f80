#pragma once

#include "io/chart/chart.h"
#include "io/chart/drawing.h"

namespace halfshade::detail {

/// Where everything of a chart is drawn.
Drawing layout(const Chart& chart);

}  // namespace halfshade::detail
