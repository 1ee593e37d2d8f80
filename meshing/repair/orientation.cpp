#include "meshing/repair/orientation.h"

#include "meshing/geometry/link.h"
#include "meshing/repair/weld.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace halfshade {
namespace {

/// A face at an edge.
struct Use {
  int face = 0;
  bool runs_up = false;  ///< from the edge's smaller point to its larger
};

using Uses = std::map<Link, std::vector<Use>>;

/// Faces that hang together.
struct Shell {
  std::vector<int> faces;
  bool is_closed = true;
  double volume = 0;  ///< of what it bounds; positive if its faces look outwards
  bool contains_light = false;
};

Uses edges_of(const Scene& scene, const std::vector<int>& of_vertex) {
  Uses uses;
  for (std::size_t f = 0; f < scene.faces.size(); ++f) {
    const std::vector<int>& loop = scene.faces[f].vertices;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int a = of_vertex[at(loop[k])], b = of_vertex[at(loop[(k + 1) % loop.size()])];
      if (a != b) uses[sorted_link(a, b)].push_back({static_cast<int>(f), a < b});
    }
  }
  return uses;
}

/// Sorts faces into shells, and marks in `reversed` those to be turned to look the way of the
/// shell's first.
std::vector<Shell> find_shells(const Scene& scene, std::vector<bool>& reversed) {
  const std::vector<int> of_vertex = weld(scene).of_vertex;
  const Uses uses = edges_of(scene, of_vertex);
  std::vector<std::vector<const std::vector<Use>*>> edges(scene.faces.size());
  for (const auto& [link, faces] : uses)
    for (const Use& use : faces) edges[at(use.face)].push_back(&faces);
  std::vector<bool> is_found(scene.faces.size());
  std::vector<Shell> shells;
  for (std::size_t first = 0; first < scene.faces.size(); ++first) {
    if (is_found[first]) continue;
    Shell& shell = shells.emplace_back();
    shell.faces = {static_cast<int>(first)};
    is_found[first] = true;
    for (std::size_t k = 0; k < shell.faces.size(); ++k)
      for (const std::vector<Use>* edge : edges[at(shell.faces[k])]) {
        if (edge->size() != 2 || (*edge)[0].face == (*edge)[1].face) {
          shell.is_closed = false;
          continue;
        }
        const bool is_second = (*edge)[0].face != shell.faces[k];
        const int other = (*edge)[is_second ? 0 : 1].face;
        if (is_found[at(other)]) continue;
        is_found[at(other)] = true;
        // Neighbours that look the same way run along their edge in opposite ways.
        const bool alike = (*edge)[0].runs_up != (*edge)[1].runs_up;
        reversed[at(other)] = reversed[at(shell.faces[k])] != !alike;
        shell.faces.push_back(other);
      }
  }
  return shells;
}

/// Calls `visit(a, b, c)` for the triangles of a fan over each face, as they are to run.
template <class Visit>
void for_each_triangle(const Scene& scene, const Shell& shell, const std::vector<bool>& reversed,
                       Visit visit) {
  for (const int f : shell.faces) {
    const std::vector<Vec3> p = face_corners(scene, f);
    for (std::size_t k = 1; k + 1 < p.size(); ++k)
      if (reversed[at(f)])
        visit(p[0], p[k + 1], p[k]);
      else
        visit(p[0], p[k], p[k + 1]);
  }
}

double volume_of(const Scene& scene, const Shell& shell, const std::vector<bool>& reversed) {
  const Vec3 origin = face_corners(scene, shell.faces.front()).front();
  double volume = 0;
  for_each_triangle(scene, shell, reversed, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    volume += (a - origin).dot((b - origin).cross(c - origin)) / 6;
  });
  return volume;
}

/// By the solid angle of the shell (van Oosterom and Strackee 1983): 4π inside, 0 outside.
bool is_inside(const Scene& scene, const Shell& shell, const std::vector<bool>& reversed,
               const Vec3& point) {
  double angle = 0;
  for_each_triangle(scene, shell, reversed, [&](const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 a = (p - point).stableNormalized(), b = (q - point).stableNormalized(),
               c = (r - point).stableNormalized();
    angle += 2 * std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
  });
  return std::abs(angle) > 2 * std::numbers::pi;
}

void find_lights(const Scene& scene, const std::vector<bool>& reversed,
                 std::vector<Shell>& shells) {
  const auto emits = [&](int f) {
    return (scene.materials[at(scene.faces[at(f)].material)].exitance > 0).any();
  };
  for (Shell& shell : shells) {
    if (!shell.is_closed) continue;
    const auto own = std::count_if(shell.faces.begin(), shell.faces.end(), emits);
    shell.contains_light = own > 0 && own < static_cast<std::ptrdiff_t>(shell.faces.size());
    for (const Shell& other : shells)
      for (const int f : other.faces) {
        if (shell.contains_light || &other == &shell || !emits(f)) continue;
        Vec3 middle = Vec3::Zero();
        const std::vector<Vec3> corners = face_corners(scene, f);
        for (const Vec3& p : corners) middle += p / static_cast<double>(corners.size());
        shell.contains_light = is_inside(scene, shell, reversed, middle);
      }
  }
}

void turn_shells(Scene& scene) {
  std::vector<bool> reversed(scene.faces.size());
  std::vector<Shell> shells = find_shells(scene, reversed);
  for (Shell& shell : shells) shell.volume = volume_of(scene, shell, reversed);
  find_lights(scene, reversed, shells);
  const auto is_smaller = [](const Shell& a, const Shell& b) {
    return std::pair(a.is_closed, std::abs(a.volume)) < std::pair(b.is_closed, std::abs(b.volume));
  };
  if (std::none_of(shells.begin(), shells.end(), [](const Shell& s) { return s.contains_light; }))
    std::max_element(shells.begin(), shells.end(), is_smaller)->contains_light = true;
  for (const Shell& shell : shells) {
    if (!shell.is_closed) continue;
    const bool turn = (shell.volume > 0) == shell.contains_light;
    for (const int f : shell.faces)
      if (reversed[at(f)] != turn)
        std::reverse(scene.faces[at(f)].vertices.begin(), scene.faces[at(f)].vertices.end());
  }
}

}  // namespace

Scene oriented(Scene scene, const SceneOptions& options) {
  if (options.orient && !scene.faces.empty()) turn_shells(scene);
  if (options.flip)
    for (Face& face : scene.faces) std::reverse(face.vertices.begin(), face.vertices.end());
  return scene;
}

}  // namespace halfshade
