#pragma once

#include "solver/reflected/light_systems.h"

namespace halfshade {

/// What equations of reflected light are made of. All must outlive it.
struct ReflectedSystem {
  const ReflectedMesh& mesh;
  const FirstLight& light;
  const IrradianceOperator& exchange;
  const LightSystems& systems;
};

struct ReflectedSolution {
  SplitIrradiance irradiance;
  /// The form in which imbalance of power is put right: what arrives if leaving light is ambient.
  ElementField ambient;
  int iterations = 0;
  double residual = 0, amplification = 1;
};

/// Solves G = K ρ G + `arriving` by the exchange's rays, where in closed systems ∫ (1 − ρ) G =
/// `power`. That gives the mean c of G weighted with q = 1 − ρ exactly, however little is absorbed:
/// G = c − m(y) + y, m the mean weighted with q, and y − K (ρ y + q m(y)) + a mean(y) = arriving −
/// c K q, a the ambient irradiance of mean 1. With exact K the plain mean of y is 0; a mean(y)
/// takes up what K does not conserve. No eigenvalue is near 0. Open systems have c = 0 and G = y.
/// `ambient` of an earlier solution may be given. Throws Error(invalid_input) if nothing absorbs
/// the power. `tolerance` is that of the residual, relative to its right hand side.
ReflectedSolution solve_reflected(const ReflectedSystem& system, const ElementField& arriving,
                                  const ChannelArray& power, double tolerance,
                                  const ElementField* ambient = nullptr);

/// The same for the exchange's own source and the power put in, so far that what the residual does,
/// amplified, is a small share of a tolerance. 0: as far as doubles go.
ReflectedSolution solve_for(const ReflectedSystem& system, double tolerance);

/// All light that comes of some that arrives, and no other power put in; `residual` as there.
ElementField all_light_of(const ReflectedSystem& system, const ElementField& arriving,
                          double residual);

/// K (S + `leaving`) by the exchange's rows.
ElementField arriving_by_rows(const ReflectedSystem& system, const ElementField& leaving);

/// The light that has been reflected 1 … bounces − 1 times before it is once more.
ReflectedSolution sum_bounces(const ReflectedSystem& system, int bounces);

/// The light that arrives after 1, 2, … `bounces` reflections, by the exchange's rays. What
/// `irradiance` is more than all of it, because more rays or a balance of power found it, is shared
/// among them on each element as their means are, so that they add up to it.
std::vector<ElementField> split_by_bounce(const ReflectedSystem& system, int bounces,
                                          const ElementField& irradiance);

}  // namespace halfshade
