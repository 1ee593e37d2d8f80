#pragma once

#include "io/read/read_formats.h"

#include <optional>
#include <string>

/// What files say of heat, and what follows from it.
namespace halfshade::reading {

/// What one entry of a file says of a material.
struct MaterialEntry {
  std::optional<Eigen::ArrayXd> rho, exitance, emissivity;  ///< one a channel, or a band
  std::optional<double> temperature;                        ///< K
  std::optional<double> net_flux;                           ///< W/m²; only 0 can be given
};

/// Fails unless what an entry says goes together; `name` is what the message calls it. emissivity
/// is 1 − reflectance; temperature tells the exitance; net_flux tells both.
void require_consistent(const MaterialEntry& entry, const std::filesystem::path& path, int line,
                        const std::string& name);

/// Makes it the material's; `place` is where it stands. What an earlier entry said of the exitance
/// no longer holds where this one says something of it. The exitances that follow from temperatures
/// are left to apply_heat.
void apply_entry(const MaterialEntry& entry, const std::string& place, Material& material,
                 MaterialOrigin& origin);

/// Gives materials the exitances and reflectances that follow from temperatures and net fluxes,
/// once all files are read and unused materials dropped. With bands they are in the heat, and in
/// the scene as to_channels has them: sums of exitances, means of reflectances where there are more
/// than channels. Fails where it is not known which part of the heat a channel has, with several
/// channels without wavelengths, and where a net flux in several bands comes without an emissivity.
Heat apply_heat(SceneDraft& draft);

}  // namespace halfshade::reading
