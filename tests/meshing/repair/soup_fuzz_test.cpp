// Whatever the triangles, the repair gives a sound scene or an Error: no crash, no hang, nothing
// else thrown. Every scene follows from the seed and the number of its run. The long run, for the
// given time, from another seed and from a run on:
//   export HALFSHADE_FUZZ_SECONDS=600 HALFSHADE_FUZZ_SEED=8 HALFSHADE_FUZZ_RUN=0
//   build/release/tests/meshing_tests --gtest_filter='*SoupFuzz*'

#include "meshing/core/error.h"
#include "meshing/core/planar.h"
#include "meshing/repair/repair.h"
#include "tests/support/fuzz_settings.h"
#include "tests/support/repair_scenes.h"
#include "tests/support/triangle_soups.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

constexpr int seconds_for_one = 20;
constexpr int short_runs = 400;

/// Triangles of about unit size that have to do with those before them, one way or another.
class MessyTriangles {
 public:
  explicit MessyTriangles(test::Random& random) : random_(random) {}

  std::array<Vec3, 3> operator()() {
    std::array<Vec3, 3> t = next();
    corners_.insert(corners_.end(), t.begin(), t.end());
    return t;
  }

 private:
  std::array<Vec3, 3> next() {
    if (corners_.empty()) return {point(), point(), point()};
    switch (random_.below(9)) {
      case 0:
        return {old(), old(), old()};
      case 1:
        return {old(), old(), point()};
      case 2:
        return in_plane_of_one();
      case 3:
        return needle();
      case 4:
        return repeated();
      case 5:
        return on_edges();
      case 6:
        return small();
      default:
        return {point(), point(), point()};
    }
  }

  /// On a grid half the time.
  Vec3 point() {
    if (random_.below(2) == 0) return random_.point(0, 1);
    const double x = random_.integer(0, 3), y = random_.integer(0, 3), z = random_.integer(0, 3);
    return {x / 3, y / 3, z / 3};
  }

  const Vec3& old() { return corners_[at(random_.below(static_cast<int>(corners_.size())))]; }

  std::array<Vec3, 3> old_triangle() {
    const auto k = at(3 * random_.below(static_cast<int>(corners_.size() / 3)));
    return {corners_[k], corners_[k + 1], corners_[k + 2]};
  }

  std::array<Vec3, 3> in_plane_of_one() {
    const auto [a, b, c] = old_triangle();
    const auto within = [&, a = a, b = b, c = c] {
      const double u = 0.25 * random_.integer(-4, 8), v = random_(-1, 2);
      return Vec3(a + u * (b - a) + v * (c - a));
    };
    return {within(), within(), within()};
  }

  /// Down to where corners are hardly told apart.
  double tiny() { return std::pow(10, random_(-16, -1)); }

  std::array<Vec3, 3> needle() {
    const Vec3 a = point(), b = old();
    return {a, b, a + random_(0, 1) * (b - a) + tiny() * random_.direction()};
  }

  /// Nearly or quite the same, looking either way.
  std::array<Vec3, 3> repeated() {
    std::array<Vec3, 3> t = old_triangle();
    if (random_.below(2) == 0) std::swap(t[0], t[1]);
    if (random_.below(2) == 0)
      for (Vec3& p : t) p += tiny() * random_.direction();
    return t;
  }

  std::array<Vec3, 3> on_edges() {
    const auto [a, b, c] = old_triangle();
    return {a + random_(0, 1) * (b - a), b + random_(0, 1) * (c - b), point()};
  }

  std::array<Vec3, 3> small() {
    const Vec3 p = random_.below(2) == 0 ? old() : point();
    const double size = tiny();
    return {p, p + size * random_.direction(), p + size * random_.direction()};
  }

  test::Random& random_;
  std::vector<Vec3> corners_;
};

Scene messy_scene(std::uint64_t seed) {
  test::Random random(seed);
  Scene scene = test::scene_of({});
  MessyTriangles next(random);
  const int count = random.integer(1, 40);
  for (int k = 0; k < count; ++k) {
    const auto [a, b, c] = next();
    test::add_polygon(scene, {a, b, c}, random.below(4));
  }
  const double scale = random.below(2) == 0 ? 1 : std::pow(10, random(-12, 12));
  const double far = random.below(2) == 0 ? 0 : std::pow(10, random(-2, 9));
  const Vec3 shift = far * random.direction();
  for (Vec3& p : scene.vertices) p = scale * (p + shift);
  return scene;
}

/// What faces may have gained by moving, at most: their borders, moved.
double area_allowed(const Scene& scene) {
  double sum = 0;
  for (int f = 0; f < static_cast<int>(scene.faces.size()); ++f) {
    const std::vector<Vec3> c = face_corners(scene, f);
    const bool is_two_sided = scene.materials[at(scene.faces[at(f)].material)].two_sided;
    const double perimeter = (c[1] - c[0]).norm() + (c[2] - c[1]).norm() + (c[0] - c[2]).norm();
    const double moved = tolerance_of(scale_of(c)).planarity;
    sum += (is_two_sided ? 2 : 1) * (area_vector(c).norm() + (perimeter + moved) * moved);
  }
  return sum * (1 + 1e-9);
}

/// How far two edges reach through each other; 0 if they only touch.
double crossing_depth(const Segment2& s, const Segment2& t) {
  const Vec2 u = s[1] - s[0], v = t[1] - t[0];
  const double a = cross_2d(u, t[0] - s[0]), b = cross_2d(u, t[1] - s[0]);
  const double c = cross_2d(v, s[0] - t[0]), d = cross_2d(v, s[1] - t[0]);
  if (!(((a > 0 && b < 0) || (a < 0 && b > 0)) && ((c > 0 && d < 0) || (c < 0 && d > 0)))) return 0;
  // Edges in line with each other have signs of rounding, but no height.
  return std::min(std::min(std::abs(a), std::abs(b)) / u.norm(),
                  std::min(std::abs(c), std::abs(d)) / v.norm());
}

void expect_simple(const Surface& surface) {
  std::vector<Segment2> edges;
  for (const Ring& ring : surface.rings) {
    ASSERT_GE(ring.size(), 3u);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      ASSERT_TRUE(ring[k].allFinite());
      edges.push_back({ring[k], ring[(k + 1) % ring.size()]});
    }
  }
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_LE(crossing_depth(edges[i], edges[j]), tolerance_of(surface).length)
          << "edges " << j << " and " << i << " of " << edges.size() << ", surface of "
          << surface.faces.size() << " faces, size " << size_of(surface);
}

double largest_coordinate(const Scene& scene) {
  double largest = 0;
  for (int f = 0; f < static_cast<int>(scene.faces.size()); ++f)
    largest = std::max(largest, scale_of(face_corners(scene, f)).magnitude);
  return largest;
}

/// Corners of the faces a surface is made of are where they were, as far as the coordinates of all
/// faces in the plane can tell: a small face joins the plane of a large one, which its far corners
/// determine no better than they are rounded.
void expect_near_its_faces(const Surface& surface, const Scene& scene) {
  const double magnitude = largest_coordinate(scene);
  for (const int f : surface.faces) {
    const LocalScale scale{magnitude, scale_of(face_corners(scene, f)).size};
    for (const Vec3& p : face_corners(scene, f))
      EXPECT_LE(std::abs(surface.frame.height(p)), tolerance_of(scale).planarity)
          << face_label(scene, f);
  }
}

enum class Fate { sound, refused };

Fate expect_sound_or_refused(const Scene& scene) {
  try {
    validate(scene);
    const SoundScene sound = make_sound(scene);
    test::expect_surfaces_sound(sound);
    for (const Surface& surface : sound.surfaces) {
      expect_simple(surface);
      expect_near_its_faces(surface, scene);
    }
    EXPECT_LE(test::total_area(sound), area_allowed(scene));
    return Fate::sound;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::invalid_input) << error.what();
  } catch (const std::exception& other) {
    ADD_FAILURE() << other.what();
  }
  return Fate::refused;
}

std::uint64_t seed_of(int seed, int run) {
  return static_cast<std::uint64_t>(seed) * 1'000'000'007 + static_cast<std::uint64_t>(run);
}

TEST(SoupFuzz, TheRepairGivesASoundSceneOrAnError) {
  const test::FuzzTime time;
  const int first = test::fuzz_setting("HALFSHADE_FUZZ_RUN", 0);
  int sound_scenes = 0, refused = 0, run = first;
  for (; run < first + short_runs || time.goes_on(); ++run) {
    SCOPED_TRACE(run);
    const Scene scene = messy_scene(seed_of(test::fuzz_seed(7), run));
    test::watch_run(run, seconds_for_one);
    (expect_sound_or_refused(scene) == Fate::sound ? sound_scenes : refused) += 1;
    test::watch_run(run, 0);
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GT(sound_scenes, (run - first) / 2);
  RecordProperty("refused", refused);
}

// One that long runs have found: every edge of a hole is there twice.
TEST(SoupFuzz, HolesThatSnapShutAreLeftOut) {
  EXPECT_EQ(expect_sound_or_refused(messy_scene(seed_of(20261126, 1843718))), Fate::sound);
}

TEST(SoupFuzz, SidesOfNeedlesBentToContactsDoNotCross) {
  for (const int run : {47013, 57755}) {
    SCOPED_TRACE(run);
    EXPECT_EQ(expect_sound_or_refused(messy_scene(seed_of(77, run))), Fate::sound);
  }
}

}  // namespace
}  // namespace halfshade
