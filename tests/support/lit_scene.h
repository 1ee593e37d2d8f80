#pragma once

#include "meshing/backprojection/edge_sum.h"
#include "meshing/core/light_source.h"
#include "meshing/events/emitter_scene.h"
#include "tests/support/discontinuity_scenes.h"

#include <utility>

namespace halfshade::test {

/// A scene with one light, and what its events are made of.
struct LitScene {
  explicit LitScene(SoundScene sound)
      : scene(std::move(sound)),
        opaque(scene),
        emitter_scene(scene, opaque, light_sources(scene).at(0).surface) {}
  explicit LitScene(const SceneMaker& maker) : LitScene(maker.sound()) {}

  /// Form factor from a point to what it sees of the light.
  double factor(const Vec3& point, const Vec3& normal) const {
    VisiblePart part;
    VisiblePartFinder(opaque).find(point, normal, emitter_scene.emitter, part);
    return enclosed_factor(point, normal, part.pieces);
  }

  SoundScene scene;
  OpaqueScene opaque;
  EmitterScene emitter_scene;
};

}  // namespace halfshade::test
