#include "meshing/discontinuity/known_pieces.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

const CurveSource face = {CurveKind::face, {Feature{Feature::Kind::face, 3}}, 1};
const CurveSource other_face = {CurveKind::face, {Feature{Feature::Kind::face, 4}}, 1};
constexpr double slack = 1e-6;

Span3 piece(double from, double to) { return {{from, 1, 0}, {to, 1, 0}}; }

TEST(KnownPieces, CoverWhatLiesOnOneOfThemInEitherDirection) {
  KnownPieces known;
  known.use(face);
  known.add(7, piece(0, 2));
  known.add(7, piece(2, 3));
  EXPECT_TRUE(known.cover(7, piece(0, 2), slack));
  EXPECT_TRUE(known.cover(7, piece(1.5, 0.5), slack));
  EXPECT_TRUE(known.cover(7, piece(-0.5 * slack, 2 + 0.5 * slack), slack));
  EXPECT_FALSE(known.cover(7, piece(1, 2.5), slack)) << "no single one is that long";
  EXPECT_FALSE(known.cover(7, piece(-2 * slack, 1), slack));
  EXPECT_FALSE(known.cover(8, piece(0, 2), slack)) << "another surface";
}

TEST(KnownPieces, AreForgottenWithTheirFace) {
  KnownPieces known;
  known.use(face);
  known.add(7, piece(0, 2));
  known.use(face);
  EXPECT_TRUE(known.cover(7, piece(0, 1), slack));
  known.use(other_face);
  EXPECT_FALSE(known.cover(7, piece(0, 1), slack));
  known.use(face);
  EXPECT_FALSE(known.cover(7, piece(0, 1), slack));
}

}  // namespace
}  // namespace halfshade
