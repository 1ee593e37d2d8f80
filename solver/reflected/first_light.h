#pragma once

#include "solver/reflected/hot_cells.h"
#include "solver/reflected/painted_elements.h"
#include "solver/reflected/reflected_light.h"
#include "solver/reflected/reflecting_scene.h"

#include <optional>
#include <vector>

namespace halfshade {

/// What the roots of a scene reflect, and the light that leaves them for the first time.
struct FirstLight {
  std::vector<int> surface;        ///< of each root
  std::vector<Rgb> rho, exitance;  ///< of each root; where it is painted, rho is the most
  PaintedElements painted;
  DirectIrradiance direct;  ///< H_d
  bool through_operator = false;
  std::optional<double> direct_square;  ///< ∫ |H_d|², if it is known better than points tell
  HotCells hot;                         ///< of what leaves; none before they are looked for

  /// H_d at a point of a root; 0 if direct light is found like reflected light.
  Rgb direct_at(int root, const Vec3& position) const {
    return through_operator ? Rgb(Rgb::Zero()) : direct(surface[at(root)], position);
  }

  /// |H_d + G|², without |H_d|² where the integral of that is known.
  double square_beside_known(const Rgb& h_d, const Rgb& g) const {
    return direct_square ? ((2 * h_d + g) * g).sum() : (h_d + g).square().sum();
  }

  /// S at a point of a root.
  Rgb leaving(int root, const Vec3& position) const {
    if (through_operator) return exitance[at(root)];
    const Rgb& most = rho[at(root)];
    return (most == 0).all() ? Rgb(Rgb::Zero())
                             : Rgb(most * painted.colour_at(root, position) *
                                   direct(surface[at(root)], position));
  }

  /// ρ f of a polynomial on an element.
  ChannelArray reflected(const ReflectedMesh& mesh, int element, const ChannelArray& f) const;

  /// Mean of (1 − ρ) f, without cancellation where nothing is painted.
  Rgb absorbed(const ReflectedMesh& mesh, int element, const ChannelArray& f) const;

  /// Mean reflectance of an element.
  Rgb mean_rho(const ReflectedMesh& mesh, int element) const;
};

FirstLight first_light(const SoundScene& scene, const ElementTable& roots, DirectIrradiance direct,
                       bool through_operator);

}  // namespace halfshade
