#pragma once

#include "meshing/backprojection/four_planes.h"
#include "meshing/backprojection/opaque_scene.h"
#include "meshing/backprojection/opaque_topology.h"
#include "meshing/backprojection/sight_candidates.h"
#include "meshing/backprojection/sight_effort.h"
#include "meshing/backprojection/silhouette_trees.h"
#include "meshing/geometry/exact_signs.h"

#include <array>
#include <utility>
#include <vector>

namespace halfshade {

/// On which side of the emitter's plane a point lies, seen from the eye.
enum class PlaneSide : std::int8_t { before = -1, on = 0, beyond = 1 };

/// A vertex as seen from the point. `position` is what decides, see PointView::start.
struct Corner : SeenPoint {
  Vec3 true_position = Vec3::Zero();
  double height = 0;  ///< above the emitter's plane; positive on the point's side
  PlaneSide side = PlaneSide::before;
  bool is_cut = false;        ///< where an edge pierces the emitter's plane
  bool is_ahead = false;      ///< clearly in the half-space of the directions to the emitter
  Vec2 image = Vec2::Zero();  ///< projected onto the emitter's plane, if ahead
  int next_on_outline = -1;   ///< the corner that follows it on the emitter's outline
};

/// What comes before the emitter in some direction, in doubles; unsure near borders of faces.
enum class ClearSight { seen, hidden, unsure };

/// A direction just beside an edge and just after its start.
struct DirectionBeside {
  int from, to;  ///< corners
  int side;      ///< +1: left of the edge, −1: right of it
};

/// The directions from one point towards one emitter that are worth looking at.
struct SightPyramid {
  std::vector<Vec3> sides;         ///< unit length, outwards; planes through the point
  std::vector<FourPlanes> planes;  ///< those of the sides and the emitter's
  Vec3 eye = Vec3::Zero(), normal = Vec3::Zero(), plane_point = Vec3::Zero();
  double slack = 0;                      ///< rounding of a distance near the pyramid
  double spread = 0;                     ///< rounding as a share of how far a box reaches
  double box_slack = 0, box_spread = 0;  ///< the same, for boxes that are left out
  Vec2 low, high;                        ///< of the outline's image

  /// When all sides are known.
  void make_planes();
  /// Neither can be wrong about something that is inside. If a box is outside, so are all segments
  /// in it.
  bool is_outside(const Bounds& box) const {
    const Vec3 centre = box.centre(), half = box.half_size();
    const double allowed = box_slack + box_spread * half.maxCoeff();
    for (const FourPlanes& four : planes)
      if (four.lowest(centre, half).maxCoeff() > allowed) return true;
    return false;
  }
  bool is_outside(const Vec3& from, const Vec3& to) const;  ///< directions of a segment's ends
  /// The box lies wholly between the point's side and the emitter's plane, clear of the latter.
  bool is_before_plane(const Bounds& box) const;
  bool crosses_plane(const Bounds& box) const;
  /// Rounding where a box is tested.
  double margin(const Bounds& box) const;
};

/// Everything about a scene that depends on the point and the emitter, found when asked for and
/// kept until the next start.
class PointView {
 public:
  explicit PointView(const OpaqueScene& scene);

  /// With a positive `jitter`, every corner decides as if it lay up to that share of the largest
  /// coordinate concerned from its true position, in a direction that depends on its rank.
  void start(const Vec3& point, const Vec3& normal, int emitter, double jitter = 0);

  const OpaqueTopology& topology() const { return topology_; }
  const SilhouetteTrees& silhouette_trees() const { return silhouette_trees_; }
  const FlatTree& face_tree() const { return face_tree_; }
  const PlaneFrame& emitter() const { return *emitter_; }
  double distance() const { return distance_; }  ///< of the point from the emitter's plane
  /// The largest coordinate of the point and the emitter, between which all that counts lies.
  double magnitude() const { return magnitude_; }
  double slack() const { return slack_; }                 ///< rounding of a distance between them
  double jitter() const { return jitter_ * magnitude_; }  ///< a length
  /// The same two where something else is seen, which may be much nearer.
  double slack_at(const Vec3& position) const;
  double jitter_at(const Vec3& position) const;
  /// How far anything may be from where it should be.
  double blur() const { return slack_ + 2 * jitter(); }
  const Vec3& point() const { return point_; }

  std::vector<Corner> corners;
  int corner_of_vertex(int vertex);
  /// Where an edge that ends on different sides of the emitter's plane pierces it.
  int corner_of_cut(int edge);
  /// One that is neither a vertex nor a cut.
  int add_corner(const Vec3& position);

  /// Until the next start, or the next call, only these triangles count: no others block anything
  /// that is looked at. nullptr: all.
  void look_among(const std::vector<int>* triangles) { among_ = triangles; }
  /// Until the next start: what may come between point and emitter, all there is to begin with.
  void narrow_to(const SightCandidates& candidates) { candidates_ = &candidates; }
  const SightCandidates& candidates() const { return *candidates_; }
  const std::vector<int>* among() const { return among_; }

  int turn(int a, int b, int c) const;
  /// All that it took since this was made; starts are looks.
  const SightEffort& effort() const { return effort_; }
  void count_boxes(std::size_t count = 1) { effort_.boxes += count; }

  /// +1 or −1 as a face's corners run counter-clockwise or clockwise seen from the point; 0 if it
  /// cannot block: it lies beyond the emitter's plane or in it, or the point lies in its plane, or
  /// it is of the emitter, whose corners may lie off its plane by what joined them to others.
  int face_sign(int triangle);
  /// One bit for each side of the pyramid that the vertex is clearly beyond; until the next start,
  /// of the pyramid that was asked about first.
  std::uint32_t sides_beyond(int vertex, const SightPyramid& pyramid);
  /// True once an edge and start.
  bool is_new(int edge) { return std::exchange(edges_[at(edge)].query, query_) != query_; }
  /// The part of a face before the emitter's plane, as up to four corners; their number.
  int clipped(int triangle, std::array<int, 4>& polygon);
  /// How many faces lie over a direction inside the pyramid, the emitter left out: Appel's
  /// quantitative invisibility (1967).
  int layers_over(const DirectionBeside& direction);
  /// In a direction inside the pyramid, without exact signs.
  ClearSight clear_sight(const Vec3& direction);
  /// The surfaces that the last call of layers_over found, perhaps repeatedly.
  std::span<const int> layer_surfaces() const { return layer_surfaces_; }
  /// How often triangle abc, as it runs, winds round the direction: ±1 or 0.
  int winding(int a, int b, int c, const DirectionBeside& direction) const {
    return winding(a, b, c, direction, 0);
  }

 private:
  struct Kept {
    std::uint32_t query = 0;
    int value = 0;
  };
  bool is_fresh(Kept& kept) const { return kept.query == query_; }
  bool is_edge_on(int surface);
  bool touches(int surface) const;
  int layers_of(int triangle, const DirectionBeside& direction);
  ClearSight clear_sight_past(int triangle, const Vec3& direction);
  template <class Visit>
  void visit_faces_along(const Vec3& direction, const Visit& visit);
  /// The same where it is known how the triangle runs; 0: it is not.
  int winding(int a, int b, int c, const DirectionBeside& direction, int sign) const;
  int add_corner(const Vec3& position, std::int64_t rank);
  void mark_vertices(int emitter);

  const OpaqueTopology& topology_;
  const SilhouetteTrees& silhouette_trees_;
  const FlatTree& face_tree_;
  const SightCandidates everything_;
  const SightCandidates* candidates_ = nullptr;
  std::vector<Kept> vertices_, cuts_, signs_, edge_on_, edges_, sides_beyond_;
  std::vector<std::uint32_t> of_emitter_;  ///< vertex → the last start for an emitter with it
  std::vector<int> layer_surfaces_;
  std::uint32_t query_ = 0;
  std::int64_t next_rank_ = 0;  ///< of corners that are neither vertices nor cuts
  const std::vector<int>* among_ = nullptr;
  Vec3 point_ = Vec3::Zero(), normal_ = Vec3::Zero();
  int emitter_id_ = -1;
  const PlaneFrame* emitter_ = nullptr;
  double distance_ = 0, magnitude_ = 0, slack_ = 0, jitter_ = 0;
  mutable SightEffort effort_;
};

}  // namespace halfshade
