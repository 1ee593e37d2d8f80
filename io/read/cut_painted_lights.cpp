#include "io/read/lamp_error.h"
#include "io/read/read_formats.h"
#include "io/read/read_text.h"
#include "meshing/core/plane_frame.h"
#include "meshing/core/rounded.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace halfshade::reading {
namespace {

/// Of the error that is asked for: what pieces are cut for, and what more of it is to be told. What
/// they shine on may lie in shadows, so that there is less light than is seen before there are any.
constexpr double aimed_share = 0.2, allowed_share = 0.4;
/// Beyond the tolerance that few pieces are for, their number grows as this power of it, and all
/// lamps together have no more than so many. Each is one more emitter in what follows.
constexpr double growth = 0.6;
constexpr std::size_t most_in_all = 4096;

/// The tolerance below which even the cells of fine grids are felt.
constexpr double finest_below = 5e-4;

std::size_t most_pieces(double tolerance, std::size_t lamps) {
  const double more = std::pow(std::max(1., usual_lamp_tolerance / tolerance), growth);
  const std::size_t each = std::max(few_pieces, most_in_all / std::max<std::size_t>(lamps, 1));
  return std::min(each, static_cast<std::size_t>(more * few_pieces));
}

class Cutter {
 public:
  Cutter(SceneDraft& draft, const LampOptions& options)
      : draft_(draft), scene_(draft.scene), options_(options) {}

  LampPictures run(const std::vector<PaintedEmitter>& given) {
    std::vector<Lamp> lamps;
    lamps.reserve(given.size());  // grids are referred to
    for (const PaintedEmitter& one : given) prepare(one, lamps);
    divide(lamps);
    for (const Lamp& lamp : lamps) replace(lamp);
    name_materials();
    say();
    draft_.picture_places.clear();  // pieces have none
    return pictures_;
  }

 private:
  /// A face with its new exitance.
  struct Part {
    int face;
    Rgb exitance;
  };

  /// What became of the faces of a material.
  struct Parted {
    std::vector<Part> parts;
    int faces = 0;         ///< in the file
    std::size_t most = 0;  ///< pieces of one of them
    double error = 0;      ///< as LampError::squared
    int worst = 0;         ///< the face on which the picture differs most from its pieces
    double uneven = 0;     ///< there, over the picture's mean
  };

  struct Lamp {
    int face;
    Paint paint;
    std::vector<Vec3> corners;
    std::unique_ptr<const PictureGrid> grid;  ///< of exitances
    FaceCut cut;
    double error = 0;  ///< as LampError::squared
  };

  void prepare(const PaintedEmitter& of, std::vector<Lamp>& lamps) {
    std::vector<Vec3> corners = face_corners(scene_, of.face);
    const GridFineness fineness = options_.tolerance < finest_below           ? GridFineness::finest
                                  : options_.tolerance < usual_lamp_tolerance ? GridFineness::fine
                                                                              : GridFineness::usual;
    auto grid = std::make_unique<PictureGrid>(make_picture_grid(of.paint, corners, fineness));
    const int material = scene_.faces[at(of.face)].material;
    for (Rgb& value : grid->value) value *= scene_.materials[at(material)].exitance;
    FaceCut cut(*grid);
    if (!(cut.sum().area > 0)) return;
    cut.cut_evenly();
    lamps.push_back({of.face, of.paint, std::move(corners), std::move(grid), std::move(cut)});
  }

  /// Into as many pieces as the tolerance takes, of what can be told of the light they give.
  void divide(std::vector<Lamp>& lamps) {
    if (lamps.empty()) return;
    pictures_.tolerance = options_.tolerance;
    const Scene turned = options_.turned ? options_.turned(scene_) : scene_;
    std::vector<ShiningFace> shining;
    for (const Lamp& lamp : lamps) shining.push_back({lamp.face, lamp.cut.sum().mean()});
    const LightReceivers receivers = light_receivers(turned, shining);
    if (!(receivers.norm > 0)) return;
    const double aimed = aimed_share * options_.tolerance * receivers.norm;
    const double each = aimed * aimed / static_cast<double>(lamps.size());
    const std::size_t most = most_pieces(options_.tolerance, lamps.size());
    double squared = 0;
    for (Lamp& lamp : lamps) {
      const bool two_sided = scene_.materials[at(scene_.faces[at(lamp.face)].material)].two_sided;
      const std::vector<Vec3> corners = face_corners(turned, lamp.face);
      const LampError error(*lamp.grid, lamp.paint, corners, two_sided, receivers);
      lamp.error = error.squared(lamp.cut.pieces());
      while (lamp.error > each && lamp.cut.pieces().size() < most) {
        const std::size_t now = lamp.cut.pieces().size();
        if (!lamp.cut.cut_further(std::min(most, now + now / 2 + 1))) break;
        lamp.error = error.squared(lamp.cut.pieces());
      }
      squared += lamp.error;
    }
    pictures_.error = std::sqrt(squared);
    pictures_.relative_error = pictures_.error / receivers.norm;
    pictures_.is_limited = pictures_.relative_error > allowed_share * options_.tolerance;
  }

  void replace(const Lamp& lamp) {
    const Face face = scene_.faces[at(lamp.face)];
    const std::vector<PicturePiece>& pieces = lamp.cut.pieces();
    const PictureSum all = lamp.cut.sum();
    Parted& parted = parted_[face.material];
    note_unevenness(lamp, all.explained(), parted);
    if (pieces.size() == 1) {
      parted.parts.push_back({lamp.face, all.mean()});
      return;
    }
    Corners known(scene_, face);
    bool is_first = true;
    for (const PicturePiece& piece : pieces) {
      const std::vector<Vec3> polygon = part_in(piece.block, *lamp.grid, lamp.paint, lamp.corners);
      if (polygon.empty()) continue;  // narrower than rounding
      Face part = face;
      part.vertices = known.of(polygon);
      parted.parts.push_back(
          {is_first ? lamp.face : static_cast<int>(scene_.faces.size()), piece.sum.mean()});
      if (is_first)
        scene_.faces[at(lamp.face)] = std::move(part);
      else
        scene_.faces.push_back(std::move(part));
      is_first = false;
    }
  }

  static void note_unevenness(const Lamp& lamp, double explained, Parted& parted) {
    const double uneven = explained > 0 ? std::sqrt(lamp.cut.deviation() / explained) : 0;
    ++parted.faces;
    parted.most = std::max(parted.most, lamp.cut.pieces().size());
    parted.error += lamp.error;
    if (uneven > parted.uneven) parted.uneven = uneven, parted.worst = lamp.face;
  }

  /// Vertices of pieces of one face: those of the face, and new ones.
  class Corners {
   public:
    Corners(Scene& scene, const Face& face) : scene_(scene) {
      for (const int v : face.vertices) known_.try_emplace(key(scene.vertices[at(v)]), v);
    }
    std::vector<int> of(const std::vector<Vec3>& polygon) {
      std::vector<int> vertices;
      for (const Vec3& p : polygon) {
        const auto [entry, is_new] =
            known_.try_emplace(key(p), static_cast<int>(scene_.vertices.size()));
        if (is_new) scene_.vertices.push_back(p);
        vertices.push_back(entry->second);
      }
      return vertices;
    }

   private:
    static std::array<double, 3> key(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

    Scene& scene_;
    std::map<std::array<double, 3>, int> known_;
  };

  /// Faces of one exitance share a material, which is the old one if it has no other.
  void name_materials() {
    for (const auto& [material, parted] : parted_) {
      std::map<std::array<double, 3>, int> known;
      const auto key = [](const Rgb& e) {
        return std::array{rounded(e[0]), rounded(e[1]), rounded(e[2])};
      };
      for (const Part& part : parted.parts) known[key(part.exitance)] = -1;
      const bool is_one = known.size() == 1 && is_all(material, parted);
      if (is_one) scene_.materials[at(material)].exitance = parted.parts[0].exitance;
      if (is_one) continue;
      int number = 0;
      for (const Part& part : parted.parts) {
        int& id = known[key(part.exitance)];
        if (id < 0) id = add_material(material, ++number, part.exitance);
        scene_.faces[at(part.face)].material = id;
      }
    }
  }

  bool is_all(int material, const Parted& parted) const {
    return std::count_if(scene_.faces.begin(), scene_.faces.end(), [&](const Face& face) {
             return face.material == material;
           }) == static_cast<std::ptrdiff_t>(parted.parts.size());
  }

  int add_material(int from, int number, const Rgb& exitance) {
    Material material = scene_.materials[at(from)];
    material.name = fmt::format("{}, part {}", material.name, number);
    material.exitance = exitance;
    scene_.materials.push_back(std::move(material));
    draft_.origins.push_back(MaterialOrigin(draft_.origins[at(from)]));
    return static_cast<int>(scene_.materials.size()) - 1;
  }

  /// Where nothing is known of what the lamps shine on, pieces that are not even are told of; else
  /// only what irradiance is off, once, by the material that it is most of.
  void say() {
    const bool is_known = pictures_.error > 0;
    const auto worst = std::max_element(
        parted_.begin(), parted_.end(),
        [](const auto& a, const auto& b) { return a.second.error < b.second.error; });
    for (auto entry = parted_.begin(); entry != parted_.end(); ++entry) {
      const auto& [material, parted] = *entry;
      const bool is_told =
          is_known ? pictures_.is_limited && entry == worst : parted.uneven > even_enough;
      if (!is_told) continue;
      std::string text = fmt::format(
          "{}: the picture that material {} shines with has more detail than even pieces show: "
          "its {} faces were cut into {} pieces, at most {} each, from which it differs by up to "
          "{:.2g} % of its mean (root mean square), most on {}; their power is right",
          scene_.source, in_quotes(draft_.origins[at(material)].name), parted.faces,
          parted.parts.size(), std::max(parted.most, few_pieces), 100 * parted.uneven,
          face_label(scene_, parted.worst));
      if (is_known) {
        text += fmt::format(
            ", but direct light is off by about {:.2g} of itself, if nothing is in between, and "
            "may be by more, where {:.2g} is asked for",
            pictures_.relative_error, options_.tolerance);
        pictures_.limit = text;
      }
      draft_.warnings.push_back(std::move(text));
    }
  }

  SceneDraft& draft_;
  Scene& scene_;
  LampOptions options_;
  LampPictures pictures_;
  std::map<int, Parted> parted_;  ///< by material
};

}  // namespace

LampPictures cut_painted_lights(SceneDraft& draft, const std::vector<PaintedEmitter>& lamps,
                                const LampOptions& options) {
  return lamps.empty() ? LampPictures{} : Cutter(draft, options).run(lamps);
}

}  // namespace halfshade::reading
