#pragma once

#include "meshing/core/light_source.h"
#include "meshing/events/emitter_stage.h"
#include "tests/support/discontinuity_scenes.h"

#include <utility>

namespace halfshade::test {

/// A scene with one light, and its stage.
struct Staged {
  explicit Staged(SoundScene sound)
      : scene(std::move(sound)),
        opaque(scene),
        stage(scene, opaque, light_sources(scene).at(0).surface) {}
  explicit Staged(const SceneMaker& maker) : Staged(maker.sound()) {}

  SoundScene scene;
  OpaqueScene opaque;
  EmitterStage stage;
};

}  // namespace halfshade::test
