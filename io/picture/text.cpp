#include "io/picture/text.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <cmath>

namespace halfshade::detail {
namespace {

constexpr int dots_per_inch = 72;  // one a point of the font's size

void set_font(vtkTextProperty* property, double size) {
  property->SetFontFamilyToArial();
  property->SetFontSize(static_cast<int>(std::lround(size)));
  property->SetColor(1, 1, 1);
}

}  // namespace

void draw_text(LineCanvas& canvas, const Vec2& place, const std::string& text,
               const TextStyle& style) {
  vtkNew<vtkTextProperty> property;
  set_font(property, style.size);
  vtkNew<vtkImageData> image;
  int size[2] = {0, 0};
  if (text.empty() ||
      !vtkTextRenderer::GetInstance()->RenderString(property, text, image, size, dots_per_inch))
    return;
  int box[4];
  vtkTextRenderer::GetInstance()->GetBoundingBox(property, text, box, dots_per_inch);
  const double share = style.anchor == Anchor::start ? 0 : style.anchor == Anchor::middle ? 0.5 : 1;
  const int shift = static_cast<int>(std::lround(-share * size[0]));
  const int x0 = static_cast<int>(std::lround(place.x()));
  const int y0 = static_cast<int>(std::lround(place.y()));
  for (int row = 0; row < size[1]; ++row)
    for (int column = 0; column < size[0]; ++column) {
      const auto* pixel =
          static_cast<const unsigned char*>(image->GetScalarPointer(column, row, 0));
      const int along = shift + column, up = box[2] + row;
      const double covered = pixel[3] / 255.;
      if (covered <= 0) continue;
      if (style.upwards)
        canvas.blend(x0 - up, y0 - along, covered, style.colour);
      else
        canvas.blend(x0 + along, y0 - up, covered, style.colour);
    }
}

int text_width(const std::string& text, double size) {
  vtkNew<vtkTextProperty> property;
  set_font(property, size);
  int box[4] = {0, 0, 0, 0};
  if (text.empty() ||
      !vtkTextRenderer::GetInstance()->GetBoundingBox(property, text, box, dots_per_inch))
    return 0;
  return box[1] - box[0] + 1;
}

}  // namespace halfshade::detail
