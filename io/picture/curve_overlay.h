#pragma once

#include "io/picture/line_canvas.h"
#include "io/picture/seen_mesh.h"

namespace halfshade::detail {

/// Draws lines in space over a picture, as far as the surfaces they lie on are seen. `width` in
/// pixels, > 0.
void overlay(LineCanvas& canvas, std::span<const OverlaidCurve> curves, const SeenMesh& seen,
             double width);

}  // namespace halfshade::detail
