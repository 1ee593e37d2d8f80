#include "meshing/events/emitter_scene.h"

#include "meshing/backprojection/opaque_topology.h"
#include "meshing/core/error.h"
#include "meshing/core/light_source.h"
#include "tests/support/lit_scene.h"
#include "tests/support/outline_pieces.h"
#include "tests/support/visible_part_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

using test::is_cut;
using test::LitScene;
using test::Random;
using test::SceneMaker;

TEST(LineOf, RunsThroughEdgesOfTheSceneAndPiecesOfTheOutline) {
  const LitScene lit(
      test::as_it_is(SceneMaker().square_light().box({0.3, -0.2, 1.6}, {0.7, 0.1, 2.3}).scene));
  const auto is_on = [](const Line3& line, const Vec3& p) {
    return line.direction.cross(p - line.point).norm() < 1e-12;
  };
  for (int e = 0; e < lit.opaque.edge_count(); ++e) {
    const Line3 line = line_of(lit.emitter_scene, lit.opaque.topology(), EdgeId::edge(e));
    for (const Vec3& p : lit.opaque.edge_ends(e)) EXPECT_TRUE(is_on(line, p));
  }
  for (const OutlinePiece& piece : lit.emitter_scene.outline) {
    const Line3 line = line_of(lit.emitter_scene, lit.opaque.topology(), piece.id);
    EXPECT_TRUE(is_on(line, piece.span.from) && is_on(line, piece.span.to));
  }
}

TEST(LineOf, FindsCutsThatAreNoPieceOfTheOutline) {
  LitScene lit(
      test::as_it_is(SceneMaker().square_light().box({0.3, -0.2, 1.6}, {0.7, 0.1, 2.3}).scene));
  const std::vector<OutlinePiece> outline = std::move(lit.emitter_scene.outline);
  lit.emitter_scene.outline.clear();
  int cuts = 0;
  for (const OutlinePiece& piece : outline) {
    if (!is_cut(piece)) continue;
    ++cuts;
    const Line3 line = line_of(lit.emitter_scene, lit.opaque.topology(), piece.id);
    for (const Vec3& p : {piece.span.from, piece.span.to})
      EXPECT_LT(line.direction.cross(p - line.point).norm(), 1e-12);
    EXPECT_GT(line.direction.norm(), 0);
  }
  EXPECT_GT(cuts, 0);
}

TEST(LineOf, RefusesWhatIsNoEdge) {
  const LitScene lit(SceneMaker().square_light().floor());
  const int edges = lit.opaque.edge_count();
  for (const EdgeId id : {EdgeId::horizon(), EdgeId::edge(edges), EdgeId::edge(-1),
                          EdgeId::emitter_edge(4), EdgeId::cut(0), EdgeId::cut(1000)})
    EXPECT_THROW(line_of(lit.emitter_scene, lit.opaque.topology(), id), Error);
}

TEST(EmitterScene, ContainsWhatACountOfCrossingsSays) {
  Random random(3);
  for (const SoundScene& scene :
       {test::light_with_a_hole(), test::l_shaped_light(), test::tilted_light()}) {
    const OpaqueScene opaque(scene);
    const int light = light_sources(scene)[0].surface;
    const EmitterScene emitter_scene(scene, opaque, light);
    const Surface& receiver = scene.surfaces[static_cast<std::size_t>(light)];
    for (int k = 0; k < 1000; ++k) {
      const Vec2 p(random(-1, 1), random(-1, 1));
      const auto depth = test::depth_inside(receiver.rings, p.cast<long double>());
      if (std::abs(depth) < 1e-6L) continue;
      EXPECT_EQ(emitter_scene.contains(receiver.frame.to_space(p)), depth > 0);
    }
    for (const Ring& ring : receiver.rings)
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
        const Vec2 out = Vec2((b - a).y(), (a - b).x()).normalized();  // the inside is left
        const Vec2 p = a + random(0, 1) * (b - a);
        EXPECT_TRUE(
            emitter_scene.contains(receiver.frame.to_space(p + 0.5 * emitter_scene.slack * out)));
        EXPECT_FALSE(
            emitter_scene.contains(receiver.frame.to_space(p + 4 * emitter_scene.slack * out)));
      }
  }
}

}  // namespace
}  // namespace halfshade
