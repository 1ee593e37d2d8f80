#pragma once

#include "io/picture/colour_map.h"
#include "io/picture/line_canvas.h"
#include "io/picture/result_file.h"
#include "io/picture/value_range.h"

namespace halfshade::detail {

/// What stands beside a picture in false colours.
struct Legend {
  std::vector<std::string> title;  ///< lines
  ValueRange range;
  ValueScale scale = ValueScale::linear;
  bool is_whole = false;              ///< a box for each code where they are few
  bool is_region = false;             ///< with the names of the codes of Region
  bool below = false, above = false;  ///< values beyond an end are seen
  ColourMap map = ColourMap::sequential;
};

/// Pixels that the legend of a picture so high takes beside it.
int legend_width(const Legend& legend, int picture_height);

/// Draws it over the columns from `x` on.
void draw_legend(LineCanvas& canvas, int x, const Legend& legend);

}  // namespace halfshade::detail
