#include "meshing/repair/narrow_gaps.h"

#include "meshing/core/planar.h"
#include "meshing/geometry/flat_tree.h"
#include "meshing/repair/common_area.h"
#include "meshing/repair/written_digits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

/// Of the largest coordinate: what computing it may have been off.
constexpr double computed = 64 * std::numeric_limits<double>::epsilon();

/// A face as the file has it.
struct WrittenFace {
  int face = 0;
  LocalScale scale;
  std::vector<Vec3> corners;
  Bounds box;
};

WrittenFace written_face(const Scene& scene, const FacePiece& piece) {
  WrittenFace result{piece.face, piece.scale, face_corners(scene, piece.face), {}};
  for (const Vec3& p : result.corners) result.box.include(p);
  result.box = result.box.grown(tolerance_of(piece.scale).planarity);
  return result;
}

/// How far one lies before another that looks at it, everywhere; 0 if digits cannot tell.
double gap_between(const WrittenFace& a, const WrittenFace& b) {
  const PlaneFrame frame = fit_plane(a.corners);
  const LocalScale scale = joint_scale(a.scale, b.scale);
  double gap = HUGE_VAL;
  for (const Vec3& p : b.corners) gap = std::min(gap, frame.height(p));
  const bool is_clear = gap > computed * scale.magnitude &&
                        gap > rounding_between(a.corners, b.corners, frame.normal) &&
                        have_common_area(a.corners, b.corners, frame, tolerance_of(scale));
  return is_clear ? gap : 0;
}

/// How far one lies before another at most, if that is all over and within what corners may be off
/// a plane; else 0.
double narrow_gap_between(const WrittenFace& a, const WrittenFace& b) {
  const PlaneFrame frame = fit_plane(a.corners);
  const LocalTolerance tolerance = tolerance_of(joint_scale(a.scale, b.scale));
  double gap = 0;
  for (const Vec3& p : b.corners) {
    const double height = frame.height(p);
    if (height <= 0 || height > tolerance.planarity) return 0;
    gap = std::max(gap, height);
  }
  return area_vector(b.corners).dot(frame.normal) < 0 &&
                 have_common_area(a.corners, b.corners, frame, tolerance)
             ? gap
             : 0;
}

Repair gap_repair(Repair::Kind kind, int a, int b, double gap) {
  return {kind, {std::min(a, b), std::max(a, b)}, gap};
}

}  // namespace

void report_shut_gaps(const Scene& scene, const std::vector<FacePiece>& pieces,
                      const PlaneClasses& classes, std::vector<Repair>& repairs) {
  std::vector<std::array<std::vector<WrittenFace>, 2>> planes(classes.frames.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const int plane = classes.of_polygon[i];
    WrittenFace face = written_face(scene, pieces[i]);
    const bool is_turned = area_vector(face.corners).dot(classes.frames[at(plane)].normal) < 0;
    std::vector<WrittenFace>& side = planes[at(plane)][is_turned ? 1 : 0];
    if (side.empty() || side.back().face != face.face) side.push_back(std::move(face));
  }
  for (const auto& [up, down] : planes) {
    if (up.empty() || down.empty()) continue;
    std::vector<Bounds> boxes;
    for (const WrittenFace& face : down) boxes.push_back(face.box);
    const FlatTree tree = make_flat_tree(boxes, 4);
    for (const WrittenFace& face : up)
      visit_overlaps(tree, face.box, [&](int k) {
        const WrittenFace& other = down[at(k)];
        if (const double gap = gap_between(face, other); gap > 0)
          repairs.push_back(gap_repair(Repair::Kind::gap_shut, face.face, other.face, gap));
      });
  }
}

void report_narrow_gaps(const Scene& scene, const std::vector<FacePiece>& pieces,
                        const PlaneClasses& classes, std::vector<Repair>& repairs) {
  std::vector<WrittenFace> faces;
  std::vector<int> plane;
  std::vector<Bounds> boxes;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const int face = pieces[i].face;
    if (scene.materials[at(scene.faces[at(face)].material)].two_sided) continue;
    if (!faces.empty() && faces.back().face == face) continue;
    faces.push_back(written_face(scene, pieces[i]));
    plane.push_back(classes.of_polygon[i]);
    boxes.push_back(faces.back().box);
  }
  const FlatTree tree = make_flat_tree(boxes, 1);
  for (int i = 0; i < static_cast<int>(faces.size()); ++i)
    visit_overlaps(tree, boxes[at(i)], [&](int k) {
      if (k <= i || plane[at(k)] == plane[at(i)]) return;
      const double gap = std::max(narrow_gap_between(faces[at(i)], faces[at(k)]),
                                  narrow_gap_between(faces[at(k)], faces[at(i)]));
      if (gap > 0)
        repairs.push_back(
            gap_repair(Repair::Kind::narrow_gap, faces[at(i)].face, faces[at(k)].face, gap));
    });
}

}  // namespace halfshade
