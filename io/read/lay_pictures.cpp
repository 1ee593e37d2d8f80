#include "io/read/read_formats.h"
#include "io/read/read_text.h"

#include <Eigen/SVD>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace halfshade::reading {
namespace {

/// Of a picture: by how much a map may miss the places given. Files round them to six digits.
constexpr double same_place = 1e-5;
/// Of a picture: what nobody sees.
constexpr double seen_bend = 1e-3;
/// Faces before one that may be laid as it is.
constexpr std::size_t neighbours = 16;

double miss(const Paint& paint, const std::vector<Vec3>& corners, const std::vector<Vec2>& places) {
  double most = 0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    most = std::max(most, (paint.place(corners[k]) - places[k]).lpNorm<Eigen::Infinity>());
  return most;
}

/// The affine map with the least squares of what it misses the places by.
Paint laid(const std::shared_ptr<const Texture>& texture, const std::vector<Vec3>& corners,
           const std::vector<Vec2>& places) {
  const auto count = static_cast<Eigen::Index>(corners.size());
  Vec3 centre = Vec3::Zero();
  Vec2 middle = Vec2::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    centre += corners[k] / static_cast<double>(count);
    middle += places[k] / static_cast<double>(count);
  }
  Eigen::MatrixXd from(count, 3), to(count, 2);
  for (Eigen::Index k = 0; k < count; ++k) {
    from.row(k) = corners[static_cast<std::size_t>(k)] - centre;
    to.row(k) = places[static_cast<std::size_t>(k)] - middle;
  }
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(from, Eigen::ComputeThinU | Eigen::ComputeThinV);
  constexpr double flat = 1e-6;  // across a plane nothing is known
  svd.setThreshold(flat);
  Paint paint;
  paint.texture = texture;
  paint.along = svd.solve(to).transpose();
  paint.from = middle - paint.along * centre;
  return paint;
}

class Layer {
 public:
  explicit Layer(SceneDraft& draft) : draft_(draft), scene_(draft.scene) {}

  std::vector<PaintedEmitter> run() {
    std::vector<PaintedEmitter> lamps;
    for (int f = 0; f < static_cast<int>(scene_.faces.size()); ++f) {
      const MaterialOrigin& origin = draft_.origins[at(scene_.faces[at(f)].material)];
      if (!origin.picture && !origin.exitance_picture) continue;
      if (at(f) >= draft_.picture_places.size() || draft_.picture_places[at(f)].empty()) {
        if (without_++ == 0) first_without_ = f;
        continue;
      }
      if (origin.picture) lay(f, *origin.picture);
      if (origin.exitance_picture) {
        const std::vector<Vec3> corners = face_corners(scene_, f);
        lamps.push_back({f, fitted(f, *origin.exitance_picture, corners,
                                   places_of(f, *origin.exitance_picture))});
      }
    }
    say();
    return lamps;
  }

 private:
  std::vector<Vec2> places_of(int f, const PictureUse& use) const {
    std::vector<Vec2> places;
    for (const Vec2& place : draft_.picture_places[at(f)])
      places.push_back(place.cwiseProduct(use.scale) + use.offset);
    return places;
  }

  void lay(int f, const PictureUse& use) {
    const std::vector<Vec3> corners = face_corners(scene_, f);
    const std::vector<Vec2> places = places_of(f, use);
    Face& face = scene_.faces[at(f)];
    const std::size_t count = scene_.paints.size();
    for (std::size_t k = 0; k < std::min(count, neighbours) && face.paint < 0; ++k) {
      const Paint& before = scene_.paints[count - 1 - k];
      if (before.texture == use.texture && miss(before, corners, places) <= same_place)
        face.paint = static_cast<int>(count - 1 - k);
    }
    if (face.paint >= 0) return;
    face.paint = static_cast<int>(count);
    scene_.paints.push_back(fitted(f, use, corners, places));
  }

  Paint fitted(int f, const PictureUse& use, const std::vector<Vec3>& corners,
               const std::vector<Vec2>& places) {
    Paint paint = laid(use.texture, corners, places);
    const double off = miss(paint, corners, places);
    if (!(off > seen_bend)) return paint;
    bent_.insert(f);
    if (off > most_bent_) most_bent_ = off, worst_ = f;
    return paint;
  }

  void say() {
    if (without_ > 0)
      draft_.warnings.push_back(fmt::format(
          "{}: {} faces have a material with a picture, but no places in it, first {}; they "
          "have its colours alone",
          scene_.source, without_, face_label(scene_, first_without_)));
    if (!bent_.empty())
      draft_.warnings.push_back(fmt::format(
          "{}: on {} faces the picture is bent or warped; it is laid on without that, most off on "
          "{}: by {:.2g} of the picture",
          scene_.source, bent_.size(), face_label(scene_, worst_), most_bent_));
  }

  SceneDraft& draft_;
  Scene& scene_;
  int without_ = 0, first_without_ = 0;
  std::set<int> bent_;
  int worst_ = 0;
  double most_bent_ = 0;
};

}  // namespace

std::vector<PaintedEmitter> lay_pictures(SceneDraft& draft) {
  const bool has_pictures = std::any_of(
      draft.origins.begin(), draft.origins.end(),
      [](const MaterialOrigin& origin) { return origin.picture || origin.exitance_picture; });
  if (!has_pictures) return {};
  const bool is_heat =
      !draft.bands.empty() || std::any_of(draft.origins.begin(), draft.origins.end(),
                                          [](const auto& origin) { return origin.says_heat; });
  if (is_heat) {
    draft.warnings.push_back(
        fmt::format("{}: pictures are not used where bands, emissivities or temperatures are given",
                    draft.scene.source));
    return {};
  }
  return Layer(draft).run();
}

}  // namespace halfshade::reading
