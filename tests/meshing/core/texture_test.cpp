#include "meshing/core/texture.h"

#include "tests/support/expect_error.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

Texture random_texture(int width, int height) {
  test::Random random(7);
  std::vector<Eigen::Array3f> texels;
  for (int k = 0; k < width * height; ++k)
    texels.emplace_back(Rgb(random(0, 1), random(0, 1), random(0, 1)).cast<float>().max(0).min(1));
  return make_texture("noise", width, height, std::move(texels));
}

Rgb mean(const TextureLevel& level) {
  Rgb sum = Rgb::Zero();
  for (const auto& texel : level.texels) sum += texel.cast<double>();
  return sum / static_cast<double>(level.texels.size());
}

TEST(Texture, SmallerCopiesHaveItsMean) {
  for (const auto& [width, height] : {std::pair{1, 1}, {8, 4}, {7, 5}, {1, 13}, {100, 3}}) {
    const Texture texture = random_texture(width, height);
    EXPECT_EQ(texture.levels.back().texels.size(), 1U);
    for (const TextureLevel& level : texture.levels) {
      EXPECT_EQ(level.texels.size(), at(level.width) * at(level.height));
      EXPECT_LT((mean(level) - mean(texture.levels[0])).abs().maxCoeff(), 1e-6);
    }
  }
}

TEST(Texture, IsLinearBetweenCentresFromTheLowerLeft) {
  const Texture texture = make_texture("two", 2, 2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  const TextureLevel& level = texture.levels[0];
  EXPECT_EQ((value_at(level, {0.75, 0.25}) - Rgb(1, 0, 0)).abs().maxCoeff(), 0);
  EXPECT_EQ((value_at(level, {0.25, 0.75}) - Rgb(0, 1, 0)).abs().maxCoeff(), 0);
  EXPECT_EQ((value_at(level, {0.5, 0.5}) - 0.25).abs().maxCoeff(), 0);
  EXPECT_EQ(value_at(level, {0.375, 0.25})[0], 0.25);
}

TEST(Texture, RepeatsWithoutMixingCopies) {
  const Texture texture = random_texture(5, 3);
  const TextureLevel& level = texture.levels[0];
  for (const Vec2& place : {Vec2(0.1, 0.2), Vec2(0.99, 0.5), Vec2(0.3, 0.01)})
    EXPECT_LT((value_at(level, place) - value_at(level, place + Vec2(-3, 2))).abs().maxCoeff(),
              1e-12);
  // Along the lower border nothing of the upper one shows.
  EXPECT_EQ((value_at(level, {0.1, 0.}) - level.texels[0].cast<double>()).abs().maxCoeff(), 0);
  EXPECT_EQ((value_at(level, {0.1, 1 - 1e-9}) - level.texels[10].cast<double>()).abs().maxCoeff(),
            0);
}

TEST(Texture, KnowsGrey) {
  EXPECT_TRUE(is_grey(make_texture("", 1, 2, {{0.2F, 0.2F, 0.2F}, {1, 1, 1}})));
  EXPECT_FALSE(is_grey(make_texture("", 1, 2, {{0.2F, 0.2F, 0.2F}, {1, 1, 0.5F}})));
}

TEST(Texture, RefusesWhatIsNone) {
  using test::expect_error;
  expect_error([] { make_texture("", 0, 1, {}); }, ErrorCode::contract, {"make_texture"});
  expect_error([] { make_texture("", 1, 1, {{0, 2, 0}}); }, ErrorCode::contract, {"from 0 to 1"});
}

TEST(Paint, LiesWhereItsMapSays) {
  Paint paint;
  paint.texture = std::make_shared<const Texture>(random_texture(4, 4));
  paint.along << 0.5, 0, 0, 0, 0, 0.25;
  paint.from = {0.125, 0};
  const Vec3 p(1, 7, 0.5);
  EXPECT_EQ(paint.place(p), Vec2(0.625, 0.125));
  EXPECT_TRUE((colour_at(paint, p) == value_at(paint.texture->levels[0], {0.625, 0.125})).all());
}

}  // namespace
}  // namespace halfshade
