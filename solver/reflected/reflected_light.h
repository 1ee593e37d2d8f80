#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "solver/direct/direct_light.h"
#include "solver/elements/element_field.h"
#include "solver/elements/error_weight.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace halfshade {

/// Direct irradiance H_d in W/m² at a point of a surface's front; called from all threads, once
/// for each ray. It may be an approximation: what it is off is off in the result, times what
/// reflects.
using DirectIrradiance = std::function<Rgb(int surface, const Vec3& position)>;

/// How irradiance at a place follows from what leaves all others.
enum class ReflectedVisibility {
  /// Exact, unless rays are expected to take far less time; where they find that light, and so
  /// their noise, is amplified, by so much more. Rays after all where elements do not help.
  automatic,
  exact,   ///< by exactly visible parts: nothing is random; for some tens or hundreds of surfaces
  sampled  ///< by rays over hemispheres
};

struct ReflectedOptions {
  ReflectedVisibility visibility = ReflectedVisibility::automatic;
  int order = 2;            ///< of the elements, 0…3
  double tolerance = 0.01;  ///< of G, relative to all irradiance in the L2 norm, > 0
  /// L2 norm of what else is off, W/m² times √area, ≥ 0: if not 0, G may be off by what that leaves
  /// of `tolerance`, or a fifth of it where nothing is left. Not with `weight`.
  double other_error = 0;
  double direct_norm = 0;       ///< L2 norm of direct irradiance, likewise; 0: found at points
  double gather_tolerance = 0;  ///< of what gather() finds by exact parts; 0: .1 `tolerance`
  double max_length = 0;        ///< of elements to begin with, scene units; 0: by the tolerance
  int max_elements = 20000;
  int max_rays = 4096;       ///< from a node of mean size, ≥ 32
  int max_rounds = 24;       ///< of solving, estimating and refining; 1: no refinement
  int bounces = -1;          ///< −1: all; n ≥ 0: light that arrives after at most n reflections
  bool each_bounce = false;  ///< keep the light of each; `bounces` must not be −1
  /// Direct light is not given but found like reflected light: what leaves first is the exitance,
  /// and the result is all irradiance. For scenes where nearly everything emits.
  bool through_operator = false;
  /// Surface → whether its area and elements count where others are compared with all; empty: all
  /// do. Those that get hardly any light should not.
  std::vector<bool> counted;
  /// Of square errors: with one, errors are relative to `norm` alone, W/m².
  ErrorWeight weight;
  double norm = 0;
};

enum class ReflectedEnd {
  accurate,     ///< the tolerance is met
  nothing,      ///< nothing is reflected: G = 0
  elements,     ///< max_elements stopped it short of the tolerance
  rays,         ///< max_rays did
  gaps,         ///< closed parts of space may lose light where surfaces count as meeting
  rounds,       ///< max_rounds did
  interrupted,  ///< what was found until then; 0 everywhere if that was nothing
};

struct ReflectedReport {
  ReflectedEnd end = ReflectedEnd::nothing;
  int elements = 0;
  std::size_t unknowns = 0;  ///< coefficients of their polynomials, for each channel
  int rounds = 0;
  bool is_exact = false;          ///< by exactly visible parts
  bool through_operator = false;  ///< it is all irradiance, see ReflectedOptions
  std::size_t rays = 0;
  std::size_t moments = 0;  ///< of exactly visible parts, kept in the last round
  /// The most by which integrals over exactly visible parts missed a point's form factors, and
  /// these, in closed systems, one, before that was put right.
  double row_error = 0;
  int systems = 0;         ///< parts that exchange no light
  int closed_systems = 0;  ///< of them, those that no light leaves: their power is balanced
  int iterations = 0;      ///< of the linear solver, in the last round
  double residual = 0;     ///< of it, relative to the light of the system
  /// The most that a residual may grow to in the result, as seen in the iteration: 1 / the smallest
  /// singular value. What is left of the residual is at most this times it.
  double amplification = 1;
  /// Estimated error of G in the L2 norm relative to all irradiance: of the polynomials and of the
  /// rays, two standard deviations of the estimate, and a fifth of that for what is reflected on;
  /// what is not known of the light that open systems lose; what the linear solver left. 1 if it
  /// was stopped before anything was found.
  double error = 0;
  double noise = 0;              ///< the rays' part in it
  double mean_square_total = 0;  ///< of all irradiance, summed over the channels, (W/m²)²
};

/// Light that arrives after at least one reflection: G = K (S + ρ G), K irradiance from leaving
/// light, S = ρ H_d (or E, see through_operator). Polynomials on a mesh that knows nothing of the
/// direct light's curves; see reflected.md. Cheap to copy. All calls may run concurrently.
class ReflectedLight {
 public:
  struct State;
  explicit ReflectedLight(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  /// G by the polynomials. Precondition: the point lies on the surface, up to rounding.
  Rgb irradiance(int surface, const Vec3& position) const;

  /// How many reflections are told apart: 0 unless ReflectedOptions::each_bounce, or 1 by exact
  /// parts if direct light goes through the operator.
  int bounces() const;
  /// The part of G that arrives after `reflections` of them, in [1, bounces()], or one less if
  /// direct light goes through the operator; the parts add up to G.
  Rgb irradiance_after(int reflections, int surface, const Vec3& position) const;

  /// G at any point, on a surface or not, by exactly visible parts if the solution is, else by
  /// about `rays` rays to what S and the polynomials say: two or three times as exact as the
  /// polynomials for 1,000 rays, and noisier for a few. Errors are independent at other points and
  /// with other patterns of rays. After a number of bounces: what arrives after one more.
  Rgb gather(const SurfacePoint& point, int rays, std::uint64_t pattern = 0) const;
  /// The same at a point of a surface, which may lie off it by rounding; 0 if it has no elements.
  Rgb gather_on(int surface, const Vec3& position, int rays, std::uint64_t pattern = 0) const;

  /// What leaves a place of a surface, S and what is reflected of G, as gather() takes it:
  /// projected on parts of elements. Nothing if the solution is by rays, which ask at the places
  /// themselves.
  std::optional<Rgb> gathered_from(int surface, const Vec3& position) const;

  const ReflectedReport& report() const;

  /// The elements and the polynomials on them. Neighbours may be split differently, so that none
  /// are given, and points are each element's own.
  const ElementTable& elements() const;
  const ElementField& field() const;

 private:
  std::shared_ptr<const State> state_;
};

/// Rays of gather() whose noise is about this share of the light in furnished rooms, as measured:
/// 1,024 for .34 %; 256 to 65,536.
int gathering_rays(double noise);

/// Solves for it. `direct` is not asked if direct light goes through the operator, and is kept for
/// gather(). The scene may go. Deterministic for any number of threads. Throws Error(contract) for
/// options out of range, Error(invalid_input) where a closed space reflects everything and light is
/// put in. Memory: 12 bytes for each of 100 rays from each node, of which elements of
/// order 0, 1, 2, 3 have 1, 3, 6, 12.
ReflectedLight reflected_light(const SoundScene& scene, const DirectIrradiance& direct,
                               const ReflectedOptions& options = {}, const Progress& progress = {});

}  // namespace halfshade
