#pragma once

#include "meshing/core/planar.h"
#include "meshing/discontinuity/discontinuity.h"
#include "tests/support/sound_scenes.h"
#include "tests/support/visible_signature.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <vector>

/// The audit of discontinuity curves: where the structure of the visible part changes along random
/// segments, there must be a curve.
namespace halfshade::test {

/// A place where a signature changes, in the receiver's plane.
struct SignatureChange {
  int receiver = 0, emitter = 0;
  Vec2 before, after;  ///< points on the segment just before and just after it
  Signature lost, gained;
  double miss = 0;  ///< distance from the nearest curve, border or contact line
};

inline Vec2 random_point(const Surface& receiver, Random& random) {
  Vec2 low = receiver.rings[0][0], high = low;
  for (const Vec2& p : receiver.rings[0]) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (;;) {
    const Vec2 p(random(low.x(), high.x()), random(low.y(), high.y()));
    if (is_inside(receiver.rings, p)) return p;
  }
}

/// Distance from the nearest border line of a surface.
inline double distance_to_border_lines(const Surface& surface, const Vec2& p) {
  double least = distance_to_rings(surface.rings, p);
  for (const auto& [a, b] : surface.contacts) least = std::min(least, distance_to_segment(p, a, b));
  return least;
}

inline bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto turn = [](const Vec2& p, const Vec2& q, const Vec2& r) {
    return (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x() > 0;
  };
  return turn(a, b, c) != turn(a, b, d) && turn(c, d, a) != turn(c, d, b);
}

struct SegmentAudit {
  std::size_t segments = 0, evaluations = 0, changes = 0;
  std::vector<SignatureChange> misses;
  std::vector<SignatureChange> at_horizon;  ///< misses of the third order
};

/// Looks at one scene with given curves.
class SegmentAuditor {
 public:
  /// Nearer than this, relative to the scene's size, two sides of a change are one place; and
  /// nearer than this a change must be to a curve. Far from the origin rounding adds to it.
  static constexpr double width = 1e-10, accepted = 1e-7;
  /// Rounding of coordinates times what ill-conditioned crossings make of it.
  static constexpr double rounding = 1e4 * 0x1p-53;
  static constexpr std::size_t most_changes = 40;  ///< in one segment

  SegmentAuditor(const SoundScene& scene, const OpaqueScene& opaque,
                 std::span<const DiscontinuityCurve> curves)
      : scene_(scene),
        signer_(scene, opaque),
        finder_(opaque),
        curves_(curves),
        size_(scene.diagonal),
        limit_(accepted * size_ + rounding * opaque.topology().magnitude) {}

  /// `count` segments on surfaces chosen at random among those where something can be seen.
  SegmentAudit run(std::span<const int> emitters, int count, std::uint64_t seed) {
    Random random(seed);
    SegmentAudit audit;
    const std::vector<Pair> pairs = choose_pairs(emitters, random);
    for (int i = 0; i < count && !pairs.empty(); ++i) {
      // Surfaces where much changes get most segments.
      const auto r =
          static_cast<std::size_t>(random.integer(0, static_cast<int>(pairs.size()) - 1));
      look_along(pairs[r], random, audit);
    }
    audit.evaluations = evaluations_;
    return audit;
  }

  Signature signature(const Vec2& p, int receiver, int emitter) {
    const PlaneFrame& frame = scene_.surfaces[static_cast<std::size_t>(receiver)].frame;
    const Vec3 point = frame.to_space(p);
    ++evaluations_;
    finder_.find(point, frame.normal, emitter, part_);
    return signer_(part_, point, frame.normal, emitter);
  }

  /// Distance from what a signature may change at.
  double distance_to_lines(const Vec2& p, int receiver, int emitter) const {
    double best = distance_to_border_lines(scene_.surfaces[static_cast<std::size_t>(receiver)], p);
    for (const DiscontinuityCurve& curve : curves_)
      if (curve.receiver == receiver && curve.emitter == emitter &&
          box_distance(curve.arc, p) < best)
        best = std::min(best, distance(curve.arc, p));
    return best;
  }

  std::string describe(const SignatureChange& change) const {
    const PlaneFrame& frame = scene_.surfaces[static_cast<std::size_t>(change.receiver)].frame;
    const Vec3 at = frame.to_space(0.5 * (change.before + change.after));
    const Vec2 across = (change.after - change.before).normalized();
    const Vec3& normal = frame.normal;
    std::string text = fmt::format(
        "receiver {} (normal {:.6g} {:.6g} {:.6g}), light {}, at ({:.17g}, {:.17g}, {:.17g}), "
        "across ({:.6g}, {:.6g}), {:.3g} from any line\n",
        change.receiver, normal.x(), normal.y(), normal.z(), change.emitter, at.x(), at.y(), at.z(),
        across.x(), across.y(), change.miss);
    for (const auto& [name, list] : {std::pair("-", &change.lost), std::pair("+", &change.gained)})
      for (const Junction& j : *list)
        text += fmt::format("  {} {} | {}\n", name, signer_.describe(j.from, change.emitter),
                            signer_.describe(j.to, change.emitter));
    return text;
  }

 private:
  struct Pair {
    int receiver, emitter;
  };

  /// Whether a change is of the third order: if it is due to the horizon and two other edges that
  /// cross on it. Along the horizon the kernel vanishes with the cosine, and for points of one
  /// plane the horizon cuts the emitter always along the same line, so that what comes and goes
  /// there is a triangle along one side of which the kernel vanishes: third order. Edges that
  /// coincide are another matter.
  bool is_at_horizon(const SignatureChange& change) const {
    std::set<EdgeId> edges;
    for (const Signature* list : {&change.lost, &change.gained})
      for (const Junction& j : *list) edges.insert({j.from, j.to});
    if (edges.erase(EdgeId::horizon()) == 0 || edges.size() > 2) return false;
    if (edges.size() < 2) return true;
    const Vec3 at = scene_.surfaces[static_cast<std::size_t>(change.receiver)].frame.to_space(
        0.5 * (change.before + change.after));
    const Vec3 a = signer_.plane_through(*edges.begin(), change.emitter, at);
    const Vec3 b = signer_.plane_through(*edges.rbegin(), change.emitter, at);
    constexpr double coincident = 1e-6;  // sine of the angle between them as seen from the point
    return a.cross(b).norm() > coincident;
  }

  static double box_distance(const ConicArc& arc, const Vec2& p) {
    const Vec2 low = arc.from.cwiseMin(arc.to).cwiseMin(arc.is_straight ? arc.to : arc.control);
    const Vec2 high = arc.from.cwiseMax(arc.to).cwiseMax(arc.is_straight ? arc.to : arc.control);
    return (p - p.cwiseMax(low).cwiseMin(high)).norm();
  }

  bool before_emitter(const Vec2& p, const Pair& pair) const {
    const Vec3 point = scene_.surfaces[static_cast<std::size_t>(pair.receiver)].frame.to_space(p);
    return scene_.surfaces[static_cast<std::size_t>(pair.emitter)].frame.height(point) >
           accepted * size_;
  }

  /// Where samples see different things, once for each thing seen; once where all see the same.
  std::vector<Pair> choose_pairs(std::span<const int> emitters, Random& random) {
    constexpr int samples = 24;
    std::vector<Pair> pairs;
    for (const int emitter : emitters)
      for (int r = 0; r < static_cast<int>(scene_.surfaces.size()); ++r) {
        std::vector<Signature> seen;
        for (int i = 0; i < samples; ++i) {
          const Vec2 p = random_point(scene_.surfaces[static_cast<std::size_t>(r)], random);
          if (before_emitter(p, {r, emitter})) seen.push_back(signature(p, r, emitter));
        }
        std::sort(seen.begin(), seen.end());
        const auto end = std::unique(seen.begin(), seen.end());
        if (seen.begin() == end || (end - seen.begin() == 1 && seen[0].empty())) continue;
        pairs.insert(pairs.end(), static_cast<std::size_t>(end - seen.begin()), {r, emitter});
      }
    return pairs;
  }

  bool crosses_border(const Vec2& a, const Vec2& b, const Surface& receiver) const {
    for (const Ring& ring : receiver.rings)
      for (std::size_t k = 0; k < ring.size(); ++k)
        if (cross(a, b, ring[k], ring[(k + 1) % ring.size()])) return true;
    return false;
  }

  void look_along(const Pair& pair, Random& random, SegmentAudit& audit) {
    const Surface& receiver = scene_.surfaces[static_cast<std::size_t>(pair.receiver)];
    Vec2 a = random_point(receiver, random), b = random_point(receiver, random);
    for (int attempt = 0; attempt < 20 && crosses_border(a, b, receiver); ++attempt)
      b = 0.5 * (a + b);
    // A chord is in front of the emitter if its ends are.
    if (crosses_border(a, b, receiver) || !before_emitter(a, pair) || !before_emitter(b, pair))
      return;
    ++audit.segments;
    constexpr int pieces = 3;  // uneven, so that symmetric scenes show what cancels
    found_ = 0;
    Vec2 from = a;
    Signature left = signature(from, pair.receiver, pair.emitter);
    for (int k = 1; k <= pieces; ++k) {
      const Vec2 to = k == pieces ? b : Vec2(a + (k + random(-0.2, 0.2)) / pieces * (b - a));
      Signature right = signature(to, pair.receiver, pair.emitter);
      bisect(pair, {from, to}, left, right, audit);
      from = to;
      left = std::move(right);
    }
  }

  void bisect(const Pair& pair, const Segment2& span, const Signature& left, const Signature& right,
              SegmentAudit& audit) {
    if (left == right || found_ >= most_changes) return;
    const Vec2 middle = 0.5 * (span[0] + span[1]);
    if ((span[1] - span[0]).norm() < width * size_ || middle == span[0] || middle == span[1]) {
      ++found_;
      ++audit.changes;
      const double miss = distance_to_lines(middle, pair.receiver, pair.emitter);
      if (miss <= limit_) return;
      SignatureChange change{pair.receiver, pair.emitter, span[0], span[1], {}, {}, miss};
      std::set_difference(left.begin(), left.end(), right.begin(), right.end(),
                          std::back_inserter(change.lost));
      std::set_difference(right.begin(), right.end(), left.begin(), left.end(),
                          std::back_inserter(change.gained));
      auto& list = is_at_horizon(change) ? audit.at_horizon : audit.misses;
      list.push_back(std::move(change));
      return;
    }
    const Signature between = signature(middle, pair.receiver, pair.emitter);
    bisect(pair, {span[0], middle}, left, between, audit);
    bisect(pair, {middle, span[1]}, between, right, audit);
  }

  const SoundScene& scene_;
  Signer signer_;
  VisiblePartFinder finder_;
  VisiblePart part_;
  std::span<const DiscontinuityCurve> curves_;
  double size_, limit_;
  std::size_t evaluations_ = 0, found_ = 0;
};

}  // namespace halfshade::test
