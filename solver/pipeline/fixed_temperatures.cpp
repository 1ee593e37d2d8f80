#include "solver/pipeline/fixed_temperatures.h"

#include "meshing/core/error.h"
#include "solver/exchange/cells.h"
#include "solver/pipeline/fewest_elements.h"

#include <fmt/format.h>

#include <numeric>

namespace halfshade {
namespace {

std::string label_of(const Scene& scene, int face) {
  return fmt::format("{}, of material '{}',", face_label(scene, face),
                     scene.materials[at(scene.faces[at(face)].material)].name);
}

/// Sets of things that are joined.
class Joined {
 public:
  explicit Joined(int count) : parent_(at(count)) { std::iota(parent_.begin(), parent_.end(), 0); }

  int set_of(int one) {
    while (parent_[at(one)] != one) one = parent_[at(one)] = parent_[at(parent_[at(one)])];
    return one;
  }

  void join(int a, int b) { parent_[at(set_of(a))] = set_of(b); }

 private:
  std::vector<int> parent_;
};

/// Heat in each cell of space and band, joined where faces of one temperature pass it on.
class Passages {
 public:
  Passages(const SoundScene& sound, const BandMaterials& materials)
      : bands_(static_cast<int>(materials.rho.cols())),
        rho_(materials.rho),
        elements_(fewest_elements(sound)),
        cells_(find_cells(sound, elements_)),
        joined_(cells_.count() * bands_),
        first_(static_cast<std::size_t>(rho_.rows()), -1) {}

  const ElementTable& elements() const { return elements_; }

  /// All that the element's material absorbs comes from and goes to one temperature.
  void pass(int element) {
    const int material = elements_.material[at(element)];
    for (int band = 0; band < bands_; ++band) {
      if (!absorbs(material, band)) continue;
      int& first = first_[at(material)];
      if (first < 0) first = place(element, band);
      joined_.join(first, place(element, band));
    }
  }

  /// Places where temperatures are fixed, by space or by what is not adiabatic.
  std::vector<bool> fixed(const std::vector<bool>& is_adiabatic) {
    std::vector<bool> result(at(cells_.count() * bands_));
    for (int cell = 0; cell < cells_.count(); ++cell)
      for (int band = 0; band < bands_; ++band)
        if (!cells_.closed[at(cell)]) result[at(joined_.set_of(cell * bands_ + band))] = true;
    for (int e = 0; e < elements_.count(); ++e)
      for (int band = 0; band < bands_; ++band)
        if (!is_adiabatic[at(e)] && absorbs(elements_.material[at(e)], band))
          result[at(joined_.set_of(place(e, band)))] = true;
    return result;
  }

  /// Where an adiabatic element's heat comes from; −1: it has no temperature.
  int place_of(int element, bool has_own) {
    if (!has_own) return joined_.set_of(place(element, 0));
    const int first = first_[at(elements_.material[at(element)])];
    return first < 0 ? -1 : joined_.set_of(first);
  }

 private:
  bool absorbs(int material, int band) const { return rho_(material, band) < 1; }
  int place(int element, int band) const { return cells_.before(element) * bands_ + band; }

  int bands_;
  const Eigen::ArrayXXd& rho_;
  ElementTable elements_;
  SpaceCells cells_;
  Joined joined_;
  std::vector<int> first_;  ///< of each material: a place of what it absorbs
};

}  // namespace

void require_fixed_temperatures(const Scene& scene, const Heat& heat,
                                const BandMaterials& materials, const std::vector<int>& original,
                                const SoundScene& sound) {
  Passages passages(sound, materials);
  const ElementTable& elements = passages.elements();
  std::vector<bool> is_adiabatic, has_own;
  for (int e = 0; e < elements.count(); ++e) {
    int material = elements.material[at(e)];
    if (!original.empty()) material = original[at(material)];
    is_adiabatic.push_back(heat.materials[at(material)].is_adiabatic);
    has_own.push_back(is_balanced(heat, scene.materials, material));
    if (has_own.back()) passages.pass(e);
  }
  const std::vector<bool> fixed = passages.fixed(is_adiabatic);
  int first = -1;
  for (int e = 0; e < elements.count(); ++e) {
    const int place = is_adiabatic[at(e)] ? passages.place_of(e, has_own[at(e)]) : -1;
    const int face = elements.face[at(e)];
    if (place >= 0 && !fixed[at(place)] && (first < 0 || face < first)) first = face;
  }
  if (first < 0) return;
  throw Error(ErrorCode::invalid_input, scene.source,
              fmt::format("{} has a net flux of 0, and so has all that it exchanges heat with: "
                          "nothing fixes their temperature; give one of them a temperature",
                          label_of(scene, first)));
}

void refuse_bands(const Scene& scene, int face) {
  throw Error(ErrorCode::invalid_input, scene.source,
              fmt::format("{} has a net flux of 0, and too little arrives there in the bands to "
                          "tell its temperature; give bands that hold more of what is sent out",
                          label_of(scene, face)));
}

Eigen::ArrayXd unseen_bands(const Heat& heat) {
  Eigen::ArrayXd result = Eigen::ArrayXd::Zero(bands_of(heat));
  const auto look = [&](const std::optional<double>& kelvin) {
    if (kelvin && *kelvin > 0)
      result = result.max((blackbody_exitance(*kelvin, heat.bands) == 0).cast<double>());
  };
  look(heat.surroundings);
  for (const HeatMaterial& said : heat.materials) look(said.temperature);
  return result;
}

}  // namespace halfshade
