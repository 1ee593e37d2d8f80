#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/core/types.h"

#include <array>
#include <memory>

namespace halfshade {

struct FlatTree;
struct OpaqueTopology;
struct SilhouetteTrees;

/// All opaque polygons of a scene, prepared for exact visibility: welded vertices, edges with the
/// faces at them, and a tree that finds the silhouette edges seen from a point without visiting
/// every face.
class OpaqueScene {
 public:
  explicit OpaqueScene(const SoundScene& scene);
  ~OpaqueScene();
  OpaqueScene(OpaqueScene&&) noexcept;
  OpaqueScene& operator=(OpaqueScene&&) noexcept;

  int edge_count() const;
  /// Where an edge of the scene runs; `edge` is in [0, edge_count()).
  std::array<Vec3, 2> edge_ends(int edge) const;
  /// How far corners of a surface lie off its plane at most, for they are those of others, too.
  double off_plane(int surface) const;

  // What it is made of; these stay where they are when the scene is moved.
  const OpaqueTopology& topology() const { return *topology_; }
  const SilhouetteTrees& silhouette_trees() const { return *silhouette_trees_; }
  const FlatTree& face_tree() const { return *face_tree_; }  ///< over the topology's triangles

 private:
  std::unique_ptr<const OpaqueTopology> topology_;
  std::unique_ptr<const SilhouetteTrees> silhouette_trees_;
  std::unique_ptr<const FlatTree> face_tree_;
};

}  // namespace halfshade
