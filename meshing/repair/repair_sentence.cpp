#include "meshing/repair/repair_sentence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace halfshade {
namespace {

constexpr std::size_t labels_in_a_sentence = 6;

std::string label(const SoundScene& scene, int face) {
  return face_label(face, scene.face_lines.at(at(face)));
}

std::string labels(const SoundScene& scene, const std::vector<int>& faces) {
  std::vector<std::string> named;
  for (std::size_t i = 0; i < std::min(faces.size(), labels_in_a_sentence); ++i)
    named.push_back(label(scene, faces[i]));
  if (faces.size() > labels_in_a_sentence)
    named.push_back(fmt::format("{} more", faces.size() - labels_in_a_sentence));
  return fmt::format("{}", fmt::join(named, ", "));
}

}  // namespace

std::string sentence(const Repair& repair, const SoundScene& scene) {
  const auto face = [&](std::size_t k) { return label(scene, repair.faces.at(k)); };
  switch (repair.kind) {
    case Repair::Kind::degenerate_dropped:
      return fmt::format("{} is thinner than {} and was dropped", face(0), repair.size);
    case Repair::Kind::duplicate_dropped:
      return fmt::format("{} has the same corners as {} and was dropped", face(0), face(1));
    case Repair::Kind::non_planar_triangulated:
      return fmt::format("{} is off its plane by {:.3g} and was triangulated", face(0),
                         repair.size);
    case Repair::Kind::crossed_split:
      return fmt::format(
          "the boundary of {} crosses itself, so that it was split; its parts look to the side "
          "from which their corners run counter-clockwise",
          face(0));
    case Repair::Kind::coplanar_merged:
      return fmt::format("{} lie in one plane and were joined", labels(scene, repair.faces));
    case Repair::Kind::overlap_removed:
      return fmt::format(
          "{0} and {1} lie in one plane and cover each other over an area of {2:.6g}, which {0} "
          "keeps",
          face(0), face(1), repair.size);
    case Repair::Kind::gap_shut:
      return fmt::format(
          "{} and {} look at each other across a gap of {:.2g}, too narrow for points so far from "
          "the origin or for faces so large, and count as touching",
          face(0), face(1), repair.size);
    case Repair::Kind::narrow_gap:
      return fmt::format(
          "{} and {} look at each other across a gap of {:.2g}, which hardly any light enters; if "
          "they are meant to be back to back, give them the same corners",
          face(0), face(1), repair.size);
  }
  return {};
}

const char* name_of(Repair::Kind kind) {
  switch (kind) {
    case Repair::Kind::degenerate_dropped:
      return "degenerate_dropped";
    case Repair::Kind::duplicate_dropped:
      return "duplicate_dropped";
    case Repair::Kind::non_planar_triangulated:
      return "non_planar_triangulated";
    case Repair::Kind::crossed_split:
      return "crossed_split";
    case Repair::Kind::coplanar_merged:
      return "coplanar_merged";
    case Repair::Kind::overlap_removed:
      return "overlap_removed";
    case Repair::Kind::gap_shut:
      return "gap_shut";
    case Repair::Kind::narrow_gap:
      return "narrow_gap";
  }
  return "";
}

}  // namespace halfshade
