#include "io/read/picture_grid.h"
#include "io/read/read_formats.h"
#include "io/read/read_text.h"
#include "meshing/core/plane_frame.h"
#include "meshing/core/rounded.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace halfshade::reading {
namespace {

/// What a picture may differ by from its pieces' means, root mean square, over the face's mean.
constexpr double even_enough = 0.02;
/// That one face is cut into.
constexpr std::size_t most_pieces = 64;
/// Of a block's squared deviation, what a cut must take away to be preferred to one along the
/// sharpest edge: where a chequerboard is cut once, both parts still have the same mean. Between 0
/// and 0.1 it matters little for other pictures.
constexpr double worth_cutting = 0.02;

/// Values over an area.
struct Sum {
  double area = 0;
  Rgb value = Rgb::Zero();  ///< times area
  double square = 0;        ///< of all channels, times area

  void add(double more, const Rgb& of) {
    area += more;
    value += more * of;
    square += more * of.square().sum();
  }
  Sum& operator+=(const Sum& other) {
    area += other.area;
    value += other.value;
    square += other.square;
    return *this;
  }
  Rgb mean() const { return value / area; }
  double explained() const { return area > 0 ? value.square().sum() / area : 0; }
  /// Squares of differences from the mean.
  double deviation() const { return std::max(0., square - explained()); }
};

/// A block of the grid, and where it is best cut.
struct Piece {
  GridBlock block;
  Sum sum;
  std::size_t axis = 0;
  int line = -1;    ///< −1: it cannot be cut
  double gain = 0;  ///< squared deviation that it takes away; what has most is cut first
};

/// One axis of a block: sums between neighbouring lines, and squares of jumps across lines.
struct Profile {
  std::vector<Sum> between;
  std::vector<double> jump;  ///< [k]: across the line before [k]
};

class FaceCut {
 public:
  explicit FaceCut(const PictureGrid& grid) : grid_(grid) {}

  /// Blocks that cover the grid. Best first.
  std::vector<Piece> run() const {
    std::vector<Piece> pieces = {make_piece(grid_.whole())};
    const double enough = even_enough * even_enough * pieces[0].sum.explained();
    while (pieces.size() < most_pieces) {
      double left = 0;
      for (const Piece& piece : pieces) left += piece.sum.deviation();
      if (left <= enough) break;
      // The first of equal ones, however they are rounded.
      const auto best = std::max_element(
          pieces.begin(), pieces.end(),
          [](const Piece& a, const Piece& b) { return rounded(a.gain) < rounded(b.gain); });
      if (best->line < 0) break;
      GridBlock lower = best->block, upper = best->block;
      lower.end[best->axis] = upper.low[best->axis] = best->line;
      *best = make_piece(lower);
      pieces.push_back(make_piece(upper));
    }
    return pieces;
  }

 private:
  Piece make_piece(const GridBlock& block) const {
    Piece piece;
    piece.block = block;
    std::array<Profile, 2> profiles;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto count = at(block.end[axis] - block.low[axis]);
      profiles[axis] = {std::vector<Sum>(count), std::vector<double>(count, 0.)};
    }
    for (int row = block.low[1]; row < block.end[1]; ++row)
      for (int column = block.low[0]; column < block.end[0]; ++column)
        add_cell(block, column, row, profiles);
    for (const Sum& column : profiles[0].between) piece.sum += column;
    choose_cut(profiles, piece);
    return piece;
  }

  void add_cell(const GridBlock& block, int column, int row,
                std::array<Profile, 2>& profiles) const {
    const std::size_t cell = grid_.cell(column, row);
    if (!(grid_.area[cell] > 0)) return;
    const std::array<int, 2> from = {column - block.low[0], row - block.low[1]};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      profiles[axis].between[at(from[axis])].add(grid_.area[cell], grid_.value[cell]);
      if (from[axis] == 0) continue;
      const std::size_t before =
          axis == 0 ? grid_.cell(column - 1, row) : grid_.cell(column, row - 1);
      profiles[axis].jump[at(from[axis])] +=
          std::min(grid_.area[cell], grid_.area[before]) *
          (grid_.value[cell] - grid_.value[before]).square().sum();
    }
  }

  static void choose_cut(const std::array<Profile, 2>& profiles, Piece& piece) {
    // Gain, or jump, then how near to the middle.
    using Rank = std::pair<double, double>;
    Rank most = {0, 0}, steepest = {0, -HUGE_VAL};
    std::pair<std::size_t, int> best = {0, -1}, edge = {0, -1};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto count = static_cast<int>(profiles[axis].between.size());
      Sum below;
      for (int k = 1; k < count; ++k) {
        below += profiles[axis].between[at(k - 1)];
        const Sum above{piece.sum.area - below.area, piece.sum.value - below.value, 0};
        constexpr double none = 1e-12;
        if (std::min(below.area, above.area) <= none * piece.sum.area) continue;
        const double off_middle = std::abs(2. * k / count - 1);
        const double gain = below.explained() + above.explained() - piece.sum.explained();
        if (const Rank rank = {rounded(std::max(gain, 0.)), -off_middle}; rank > most)
          most = rank, best = {axis, k};
        const Rank rank = {rounded(profiles[axis].jump[at(k)]), -off_middle};
        if (rank.first > 0 && rank > steepest) steepest = rank, edge = {axis, k};
      }
    }
    const double least = worth_cutting * piece.sum.deviation();
    const bool by_gain = edge.second < 0 || most.first >= least;
    const auto& cut = by_gain ? best : edge;
    if (cut.second < 0) return;
    piece.axis = cut.first;
    piece.line = piece.block.low[cut.first] + cut.second;
    piece.gain = std::max(most.first, least);
  }

  const PictureGrid& grid_;
};

class Cutter {
 public:
  explicit Cutter(SceneDraft& draft) : draft_(draft), scene_(draft.scene) {}

  void run(const std::vector<PaintedEmitter>& lamps) {
    for (const PaintedEmitter& lamp : lamps) cut(lamp);
    name_materials();
    say();
    draft_.picture_places.clear();  // pieces have none
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
    int faces = 0;      ///< in the file
    int worst = 0;      ///< the face on which the picture differs most from its pieces
    double uneven = 0;  ///< there, over the picture's mean
  };

  void cut(const PaintedEmitter& lamp) {
    const Face face = scene_.faces[at(lamp.face)];
    const std::vector<Vec3> corners = face_corners(scene_, lamp.face);
    PictureGrid grid = make_picture_grid(lamp.paint, corners);
    for (Rgb& value : grid.value) value *= scene_.materials[at(face.material)].exitance;
    const std::vector<Piece> pieces = FaceCut(grid).run();
    Sum all;
    for (const Piece& piece : pieces) all += piece.sum;
    if (!(all.area > 0)) return;
    Parted& parted = parted_[face.material];
    note_unevenness(lamp.face, pieces, all.explained(), parted);
    if (pieces.size() == 1) {
      parted.parts.push_back({lamp.face, all.mean()});
      return;
    }
    Corners known(scene_, face);
    bool is_first = true;
    for (const Piece& piece : pieces) {
      const std::vector<Vec3> polygon = part_in(piece.block, grid, lamp.paint, corners);
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

  static void note_unevenness(int face, const std::vector<Piece>& pieces, double explained,
                              Parted& parted) {
    double left = 0;
    for (const Piece& piece : pieces) left += piece.sum.deviation();
    const double uneven = explained > 0 ? std::sqrt(left / explained) : 0;
    ++parted.faces;
    if (uneven > parted.uneven) parted.uneven = uneven, parted.worst = face;
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

  void say() {
    for (const auto& [material, parted] : parted_)
      if (parted.uneven > even_enough)
        draft_.warnings.push_back(fmt::format(
            "{}: the picture that material {} shines with has more detail than even pieces show: "
            "its {} faces were cut into {} pieces, at most {} each, from which it differs by up to "
            "{:.2g} % of its mean (root mean square), most on {}; their power is right",
            scene_.source, in_quotes(draft_.origins[at(material)].name), parted.faces,
            parted.parts.size(), most_pieces, 100 * parted.uneven,
            face_label(scene_, parted.worst)));
  }

  SceneDraft& draft_;
  Scene& scene_;
  std::map<int, Parted> parted_;  ///< by material
};

}  // namespace

void cut_painted_lights(SceneDraft& draft, const std::vector<PaintedEmitter>& lamps) {
  if (!lamps.empty()) Cutter(draft).run(lamps);
}

}  // namespace halfshade::reading
