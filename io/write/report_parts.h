#pragma once

#include "io/write/run_info.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "solver/exchange/exchange.h"
#include "solver/linear/radiosity.h"
#include "solver/pipeline/solve.h"
#include "solver/pipeline/stages.h"
#include "solver/pipeline/warnings.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

/// What reports on different commands have in common: plain structs as JSON objects.
namespace halfshade::detail {

using Json = nlohmann::ordered_json;

/// What every report begins with.
Json head_json(const RunInfo& run);
/// What lengths, areas and powers are in where their keys do not say so.
Json units_json(const std::string& unit);
/// How much there is of everything, and the names that go with the numbers in result files.
Json scene_json(const SoundScene& scene, const std::vector<Camera>& cameras);
/// Faces count from 1 here, as in the sentences.
Json repairs_json(const SoundScene& scene);
Json warnings_json(const std::vector<Warning>& warnings);
Json stages_json(const std::vector<StageReport>& stages);

/// Numbers and angles of the elements.
Json mesh_json(const ElementTable& elements);
/// Shares of the area by smallest angle; what lies at input angles stands apart.
Json area_quality_json(const ElementTable& elements);

/// How curves were found, and what the mesh made of them.
Json search_json(const DiscontinuityReport& report);
Json along_curves_json(const DiscontinuityMeshReport& report);

Json exchange_json(const ExchangeReport& report);
/// Of direct light as polynomials, and of reflected light on its own mesh.
Json direct_json(const AdaptiveFieldReport& report, const ElementField& field);
/// How polynomials were cut for files.
Json straight_json(const StraightCut& cut);
Json goal_json(const GoalResult& goal, const SoundScene& scene);
Json reflected_json(const ReflectedReport& report);
/// One channel where all are equal.
Json radiosity_json(const RadiosityReport& report);
/// In SI units, whatever the scene's is. Throws as sum_heat does.
Json net_exchange_json(const SolveResult& result);
Json subdivision_json(const SubdivisionReport& report);

}  // namespace halfshade::detail
