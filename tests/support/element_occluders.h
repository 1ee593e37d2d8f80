#pragma once

#include "meshing/patches/element_table.h"
#include "meshing/rays/visibility.h"

namespace halfshade::test {

/// The elements as triangles; owner = element, plane = −1.
inline TriangleSoup occluders(const ElementTable& elements) {
  TriangleSoup soup;
  soup.points = elements.points;
  soup.triangles = elements.corners;
  for (int e = 0; e < elements.count(); ++e) soup.owner.push_back(e);
  soup.plane.assign(soup.triangles.size(), -1);
  return soup;
}

}  // namespace halfshade::test
