#pragma once

#include "io/picture/view.h"
#include "meshing/rays/visibility.h"

#include <optional>

namespace halfshade::detail {

/// A mesh as rays from a camera see it: by its fronts.
class SeenMesh {
 public:
  /// `mesh` must outlive this. Throws Error(contract) if its arrays do not fit.
  SeenMesh(const ShadedMesh& mesh, const View& view, Shading shading);

  std::optional<Hit> cast(const Vec3& ray) const { return cast(view_.origin, ray); }
  /// The same from elsewhere.
  std::optional<Hit> cast(const Vec3& origin, const Vec3& ray) const;

  /// What the mesh carries there, between the corners and by its picture, or one for the triangle.
  Rgb value(const Hit& hit) const;
  /// That of the whole triangle, whatever the shading.
  const Rgb& triangle_value(const Hit& hit) const {
    return mesh_->triangle_value[at(hit.triangle)];
  }
  bool emits(const Hit& hit) const { return mesh_->emits[at(hit.triangle)] != 0; }
  /// Of unit length, to the front.
  Vec3 normal(const Hit& hit) const;

  /// Whether the ray meets an element's border within half a pixel.
  bool is_on_border(const Hit& hit, const Vec3& ray) const;

  /// Whether a point of one of the surfaces is seen; it may lie on the surface's border.
  bool shows(const Vec3& point) const;

  const View& view() const { return view_; }

 private:
  std::array<Vec3, 3> corners(const Hit& hit) const;

  const ShadedMesh* mesh_;
  View view_;
  Shading shading_;
  std::optional<VisibilityIndex> index_;
};

}  // namespace halfshade::detail
