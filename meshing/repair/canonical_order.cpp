#include "meshing/repair/canonical_order.h"

#include "meshing/core/rounded.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace halfshade {
namespace {

using Coordinates = std::array<double, 3>;

/// Where a vertex stands: coordinates that are equal but for rounding in another unit, too, and
/// themselves.
std::pair<Coordinates, Coordinates> place_of(const Vec3& v) {
  const Coordinates exactly = {v.x(), v.y(), v.z()};
  return {{rounded(v.x()), rounded(v.y()), rounded(v.z())}, exactly};
}

/// Begins with the first of all vertices; if it has that several times, what comes next decides.
void begin_with_first(std::vector<int>& vertices) {
  const int first = *std::min_element(vertices.begin(), vertices.end());
  std::vector<int> best;
  for (auto v = vertices.begin(); v != vertices.end(); ++v) {
    if (*v != first) continue;
    std::vector<int> turned(v, vertices.end());
    turned.insert(turned.end(), vertices.begin(), v);
    if (best.empty() || turned < best) best = std::move(turned);
  }
  vertices = std::move(best);
}

}  // namespace

OrderedScene in_canonical_order(const Scene& scene) {
  OrderedScene result;
  Scene& ordered = result.scene = scene;
  std::vector<std::pair<decltype(place_of({})), int>> places;
  for (std::size_t v = 0; v < scene.vertices.size(); ++v)
    places.emplace_back(place_of(scene.vertices[v] + Vec3::Zero()), static_cast<int>(v));  // −0: 0
  std::sort(places.begin(), places.end());
  std::vector<int> now(scene.vertices.size());
  ordered.vertices.clear();
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto& [place, v] = places[k];
    if (k == 0 || place.second != places[k - 1].first.second)
      ordered.vertices.emplace_back(place.second[0], place.second[1], place.second[2]);
    now[at(v)] = static_cast<int>(ordered.vertices.size()) - 1;
  }
  for (Face& face : ordered.faces) {
    for (int& v : face.vertices) v = now[at(v)];
    begin_with_first(face.vertices);
  }
  result.face.resize(scene.faces.size());
  std::iota(result.face.begin(), result.face.end(), 0);
  std::stable_sort(result.face.begin(), result.face.end(), [&](int a, int b) {
    return ordered.faces[at(a)].vertices < ordered.faces[at(b)].vertices;
  });
  std::vector<Face> faces;
  for (const int f : result.face) faces.push_back(std::move(ordered.faces[at(f)]));
  ordered.faces = std::move(faces);
  return result;
}

}  // namespace halfshade
