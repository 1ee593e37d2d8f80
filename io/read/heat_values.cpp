#include "io/read/heat_values.h"

#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade::reading {
namespace {

/// Numbers as they are typed: 0.3 and 0.7 make one.
constexpr double typed = 1e-9;

std::string text_of(const Rgb& value) {
  return value[0] == value[1] && value[0] == value[2]
             ? fmt::format("{}", value[0])
             : fmt::format("[{}, {}, {}]", value[0], value[1], value[2]);
}

bool is_grey(const Rgb& value, std::size_t channels) {
  for (std::size_t c = 1; c < channels; ++c)
    if (value[static_cast<int>(c)] != value[0]) return false;
  return true;
}

/// The first material that differs between channels; none if the scene has one channel.
const Material* first_coloured(const SceneDraft& draft) {
  for (const Material& material : draft.scene.materials)
    if (!is_grey(material.rho, 3) || !is_grey(material.exitance, 3)) return &material;
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
  if (is_adiabatic)
    refuse(
        fmt::format("but there are {} bands, which its temperature would have to balance "
                    "together; that takes a single band",
                    bands.size()));
  for (const Band& band : bands)
    if (!band.has_wavelengths)
      refuse(
          fmt::format("but the band {} has no 'wavelengths_um', so its part of the heat is not "
                      "known",
                      in_quotes(band.name)));
}

/// Fails where a scene file gives colours that bands cannot be. Channels without a band get
/// nothing, and with one band all are alike.
void fit_bands(SceneDraft& draft) {
  const std::size_t bands = draft.bands.size();
  for (std::size_t m = 0; m < draft.origins.size(); ++m) {
    Material& material = draft.scene.materials[m];
    const MaterialOrigin& origin = draft.origins[m];
    for (Rgb* value : {&material.rho, &material.exitance}) {
      const bool is_by_band = value == &material.rho ? origin.rho_by_band : origin.exitance_by_band;
      if (!is_by_band && (!is_grey(*value, 3) || (value == &material.exitance && (*value)[0] > 0)))
        fail(draft.scene.source, 0,
             fmt::format("material {} has the {} {} of the scene's file; give it for the {} band{} "
                         "of the materials",
                         in_quotes(material.name),
                         value == &material.rho ? "reflectance" : "exitance", text_of(*value),
                         bands, bands == 1 ? "" : "s"));
      for (std::size_t c = bands; c < 3; ++c)
        (*value)[static_cast<int>(c)] = bands == 1 ? (*value)[0] : 0;
    }
  }
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
  if (entry.rho) material.rho = *entry.rho;
  if (entry.emissivity) material.rho = 1 - *entry.emissivity;
  if (entry.rho || entry.emissivity) origin.rho_place = place;
  if (entry.exitance) material.exitance = *entry.exitance;
  if (entry.temperature || entry.net_flux) material.exitance.setZero();
  if (entry.exitance || entry.temperature || entry.net_flux) {
    origin.exitance_place = place;
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
  if (!heat.bands.empty()) fit_bands(draft);
  for (std::size_t m = 0; m < draft.origins.size(); ++m) {
    Material& material = draft.scene.materials[m];
    const HeatMaterial& said = draft.origins[m].heat;
    if (said.is_adiabatic) material.rho.setOnes();
    heat.materials.push_back(said);
  }
  for (std::size_t m = 0; m < draft.origins.size(); ++m) {
    const HeatMaterial& said = heat.materials[m];
    Material& material = draft.scene.materials[m];
    if (!said.temperature && !said.is_adiabatic) continue;
    require_known_parts(draft, material.name, said.is_adiabatic);
  }
  // Only now, for an exitance by bands is no colour.
  for (std::size_t m = 0; m < draft.origins.size(); ++m)
    if (const auto& temperature = heat.materials[m].temperature)
      draft.scene.materials[m].exitance =
          (1 - draft.scene.materials[m].rho) * blackbody_exitance(*temperature, heat.bands);
  return heat;
}

}  // namespace halfshade::reading
