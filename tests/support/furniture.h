#pragma once

#include "tests/support/scene_maker.h"

namespace halfshade::test {

/// A table and two chairs under a ceiling light, of boxes that touch along faces.
SceneMaker table_and_chairs_maker();

}  // namespace halfshade::test
