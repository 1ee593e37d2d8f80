#pragma once

#include "solver/pipeline/solve.h"

namespace halfshade {

/// Straight triangles that files may hold in all, unless there are more elements: some 500 MB of
/// numbers as .vtu, and about what programs that show them can still turn on a screen.
inline constexpr int most_straight_triangles = 2'000'000;

/// What polynomials may be off, where straight triangles take the rest of the tolerance; see
/// SolveOptions::straight.
double tolerance_of_polynomials(const SolveOptions& options);

/// What straight triangles may be off where nothing else is said: they add little to a result's
/// error, or to a thousandth of its light.
double little_error(const SolveResult& result);

/// How finely to cut a result's polynomials so that lines are off by a share of the irradiance, in
/// the L2 norm. Precondition: it has polynomials.
StraightCut cut_to(const SolveResult& result, double allowed);

/// Cuts the polynomials of a result so finely that straight triangles are within the tolerance.
/// Where polynomials are not, or elements that were asked for are better, lines add little to their
/// error. Says so in SolveResult::not_reached where the tolerance takes too many triangles. Does
/// nothing to constant elements, nor to light that is not complete.
void cut_for_files(const SolveOptions& options, SolveResult& result);

/// Whether cut_for_files was here.
bool is_cut(const SolveResult& result);

/// Of straight triangles in place of a result's polynomials, relative, in the L2 norm; with a goal
/// its own, for means stay what they are.
double error_of_triangles(const SolveResult& result, const StraightCut& cut);

/// Of what files hold: straight triangles, if the result was cut for them.
double error_of_files(const SolveResult& result);

}  // namespace halfshade
