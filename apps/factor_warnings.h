#pragma once

#include "io/read/read_scene.h"
#include "meshing/core/scene.h"
#include "solver/factors/factor_matrix.h"
#include "solver/pipeline/warnings.h"

#include <string>
#include <vector>

namespace halfshade {

/// What to doubt of form factors: what making the scene sound changed, as solve says of its light,
/// and faces that were no more than nearly flush; what backs swallow.
std::vector<Warning> warnings_of(const Scene& scene, const FactorMatrix& matrix);

/// What a maker of a scene wants, but what rows of the matrix tell of all the same: rugs and lamps
/// flush on larger faces, whose rows have less area for it. Empty if there are none.
std::string note_of(const Scene& scene, const FactorMatrix& matrix);

/// Groups that the file names and gives no faces. Empty if there are none, or rows are not groups'.
std::string rows_without_faces(const SceneFile& file, FactorUnit unit);

/// Groups or materials whose faces all had no area or were dropped, so that they have no row. Empty
/// if there are none, and for faces: what was dropped of those tells it.
std::string missing_rows(const Scene& scene, const FactorMatrix& matrix, FactorUnit unit);

}  // namespace halfshade
