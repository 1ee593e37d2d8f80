#include "io/read/heat_values.h"

#include "io/read/read_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace halfshade::reading {
namespace {

/// Numbers as they are typed: 0.3 and 0.7 make one.
constexpr double typed = 1e-9;

std::string text_of(const Eigen::ArrayXd& values) {
  if ((values == values[0]).all()) return fmt::format("{}", values[0]);
  return fmt::format("[{}]", fmt::join(values.begin(), values.end(), ", "));
}

bool is_grey(const Rgb& value) { return (value == value[0]).all(); }

/// The first material that differs between channels; none if the scene has one channel.
const Material* first_coloured(const SceneDraft& draft) {
  for (const Material& material : draft.scene.materials)
    if (!is_grey(material.rho) || !is_grey(material.exitance)) return &material;
  return nullptr;
}

/// Fails unless every channel's part of σT⁴ is known, for the material called `name`.
void require_known_parts(const SceneDraft& draft, const std::string& name, bool is_adiabatic) {
  const std::vector<Band>& bands = draft.bands;
  const auto refuse = [&](const std::string& sentence) {
    fail(draft.scene.source, 0,
         fmt::format("material {} has a {}, {}", in_quotes(name),
                     is_adiabatic ? "net flux" : "temperature", sentence));
  };
  const Material* coloured = bands.empty() ? first_coloured(draft) : nullptr;
  if (coloured)
    refuse(
        fmt::format("but material {} differs between red, green and blue, of which no part of "
                    "the heat is known; give the materials 'bands' with 'wavelengths_um'",
                    in_quotes(coloured->name)));
  if (bands.size() < 2) return;
  for (const Band& band : bands)
    if (!band.has_wavelengths)
      refuse(
          fmt::format("but the band {} has no 'wavelengths_um', so its part of the heat is not "
                      "known",
                      in_quotes(band.name)));
}

/// A value for each band: as given, or the scene file's if it says nothing of colours, nor of
/// light.
Eigen::ArrayXd fit_bands(const SceneDraft& draft, std::size_t material, bool is_rho) {
  const MaterialOrigin& origin = draft.origins[material];
  const auto& by_band = is_rho ? origin.rho_by_band : origin.exitance_by_band;
  if (by_band) return *by_band;
  const Material& has = draft.scene.materials[material];
  const Rgb& value = is_rho ? has.rho : has.exitance;
  const std::size_t bands = draft.bands.size();
  if (!is_grey(value) || (!is_rho && value[0] > 0))
    fail(draft.scene.source, 0,
         fmt::format("material {} has the {} {} of the scene's file; give it for the {} band{} of "
                     "the materials",
                     in_quotes(has.name), is_rho ? "reflectance" : "exitance", text_of(value),
                     bands, bands == 1 ? "" : "s"));
  return Eigen::ArrayXd::Constant(static_cast<Eigen::Index>(bands), value[0]);
}

/// What a material reflects and sends out in each band.
void take_band_values(const SceneDraft& draft, std::size_t material, HeatMaterial& said) {
  if (draft.bands.empty()) return;
  said.rho = fit_bands(draft, material, true);
  said.exitance = fit_bands(draft, material, false);
}

/// Adiabatic surfaces reflect all that arrives, unless they balance several bands or two sides.
void settle_adiabatic(SceneDraft& draft, std::size_t material, Heat& heat) {
  if (!is_balanced(heat, draft.scene.materials, static_cast<int>(material))) {
    if (heat.bands.empty()) draft.scene.materials[material].rho.setOnes();
    heat.materials[material].rho.setOnes();
    return;
  }
  if (!draft.origins[material].rho_place.empty()) return;
  fail(draft.scene.source, 0,
       fmt::format("material {} has a net flux, but no emissivity, on which its temperature "
                   "depends where {}",
                   in_quotes(draft.scene.materials[material].name),
                   bands_of(heat) > 1 ? fmt::format("there are {} bands", bands_of(heat))
                                      : "faces have two sides"));
}

}  // namespace

void require_consistent(const MaterialEntry& entry, const std::filesystem::path& path, int line,
                        const std::string& name) {
  const auto refuse = [&](const std::string& sentence) {
    fail(path, line, name + ": " + sentence);
  };
  if (entry.emissivity && !((*entry.emissivity >= 0).all() && (*entry.emissivity <= 1).all()))
    refuse(fmt::format("the emissivity is {}; it must lie in [0, 1]", text_of(*entry.emissivity)));
  if (entry.temperature && !(*entry.temperature >= 0 && std::isfinite(*entry.temperature)))
    refuse(fmt::format("the temperature is {} K; it must be finite and not below 0 K",
                       *entry.temperature));
  if (entry.net_flux && *entry.net_flux != 0)
    refuse(
        fmt::format("the net flux is {} W/m²; only 0 (adiabatic) can be given", *entry.net_flux));
  if (entry.rho && entry.emissivity && ((*entry.rho + *entry.emissivity - 1).abs() > typed).any())
    refuse(
        fmt::format("reflectance {} and emissivity {} contradict each other: they must add up "
                    "to 1; give one of them",
                    text_of(*entry.rho), text_of(*entry.emissivity)));
  if (entry.temperature && entry.exitance)
    refuse(
        fmt::format("temperature {} K and exitance {} W/m² contradict each other, for the "
                    "exitance follows from the temperature; give one of them",
                    *entry.temperature, text_of(*entry.exitance)));
  if (entry.net_flux && (entry.temperature || entry.exitance))
    refuse(
        fmt::format("net_flux 0 and {} contradict each other, for the temperature is what is "
                    "found; give one of them",
                    entry.temperature ? fmt::format("temperature {} K", *entry.temperature)
                                      : fmt::format("exitance {} W/m²", text_of(*entry.exitance))));
}

void apply_entry(const MaterialEntry& entry, const std::string& place, Material& material,
                 MaterialOrigin& origin) {
  const auto channels = [](const Eigen::ArrayXd& values) {
    return to_channels(values, values.sum());
  };
  if (entry.rho) material.rho = channels(*entry.rho);
  if (entry.emissivity) material.rho = channels(1 - *entry.emissivity);
  if (entry.rho || entry.emissivity) {
    origin.rho_place = place;
    origin.picture.reset();
  }
  if (entry.exitance) material.exitance = channels(*entry.exitance);
  if (entry.temperature || entry.net_flux) material.exitance.setZero();
  if (entry.exitance || entry.temperature || entry.net_flux) {
    origin.exitance_place = place;
    origin.exitance_by_band.reset();
    origin.exitance_picture.reset();
    origin.heat = {entry.temperature, entry.net_flux.has_value()};
  }
  origin.says_heat = origin.says_heat || entry.emissivity || entry.temperature || entry.net_flux;
}

Heat apply_heat(SceneDraft& draft) {
  Heat heat;
  heat.is_given = !draft.bands.empty();
  for (const MaterialOrigin& origin : draft.origins) heat.is_given |= origin.says_heat;
  if (!heat.is_given) return heat;
  heat.bands = draft.bands;
  for (std::size_t m = 0; m < draft.origins.size(); ++m) {
    HeatMaterial said = draft.origins[m].heat;
    take_band_values(draft, m, said);
    heat.materials.push_back(std::move(said));
    if (heat.materials[m].is_adiabatic) settle_adiabatic(draft, m, heat);
  }
  for (std::size_t m = 0; m < draft.origins.size(); ++m) {
    const HeatMaterial& said = heat.materials[m];
    if (said.temperature || said.is_adiabatic)
      require_known_parts(draft, draft.scene.materials[m].name, said.is_adiabatic);
  }
  // Only now, for an exitance by bands is no colour.
  for (std::size_t m = 0; m < draft.origins.size(); ++m) {
    HeatMaterial& said = heat.materials[m];
    Material& material = draft.scene.materials[m];
    const auto black = [&] { return blackbody_exitance(*said.temperature, heat.bands); };
    if (heat.bands.empty()) {
      if (said.temperature) material.exitance = (1 - material.rho) * black()[0];
      continue;
    }
    if (said.temperature) said.exitance = (1 - said.rho) * black();
    material.rho = to_channels(said.rho, said.rho.mean());
    material.exitance = to_channels(said.exitance, said.exitance.sum());
  }
  return heat;
}

}  // namespace halfshade::reading
