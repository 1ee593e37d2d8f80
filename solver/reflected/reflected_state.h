#pragma once

#include "solver/reflected/exact_gather.h"
#include "solver/reflected/exact_sight.h"
#include "solver/reflected/irradiance_row.h"
#include "solver/reflected/leaving_field.h"
#include "solver/reflected/quick_field.h"
#include "solver/reflected/reflected_light.h"

#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace halfshade {

/// All that a solution is made of.
struct ReflectedLight::State {
  State(ReflectingScene all, FirstLight first, ReflectedMesh elements)
      : reflecting(std::move(all)), light(std::move(first)), mesh(std::move(elements)) {}

  ReflectingScene reflecting;
  FirstLight light;
  std::unique_ptr<const SoundScene> scene;  ///< for exact parts, as the next two
  std::unique_ptr<const ExactSight> sight;
  RowAccuracy accuracy, gather_accuracy;
  Rgb scale = Rgb::Ones();  ///< of light while it is solved for: no size of it over- or underflows
  ReflectedMesh mesh;
  ElementTable elements;
  ElementField field;
  ElementField leaving_rest;             ///< what leaves, without S
  std::optional<QuickField> irradiance;  ///< by triangles of the mesh, as the next
  std::optional<LeavingField> leaving;
  std::vector<ElementField> by_bounce;           ///< if asked for, as the next
  std::vector<QuickField> irradiance_by_bounce;  ///< likewise
  ReflectedReport report;
  mutable std::once_flag gather_made;
  mutable std::optional<ExactGather> gather;  ///< made when it is asked for
};

}  // namespace halfshade
