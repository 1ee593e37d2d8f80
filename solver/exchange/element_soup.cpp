#include "solver/exchange/element_soup.h"

namespace halfshade {

TriangleSoup element_soup(const SoundScene& scene, const ElementTable& elements) {
  TriangleSoup soup;
  soup.points = elements.points;
  soup.triangles = elements.corners;
  for (int e = 0; e < elements.count(); ++e) {
    soup.owner.push_back(e);
    soup.plane.push_back(scene.surfaces[at(elements.surface[at(e)])].plane);
  }
  return soup;
}

}  // namespace halfshade
