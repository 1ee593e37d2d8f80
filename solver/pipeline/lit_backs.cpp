#include "solver/pipeline/lit_backs.h"

#include <algorithm>
#include <optional>

namespace halfshade {
namespace {

/// Pairs of surfaces that are compared at most.
constexpr long most_pairs = 20'000'000;

/// Whether a part of `other` lies before a surface (`side` 1), or behind it (−1).
bool has_part(const Surface& surface, double side, const Surface& other) {
  const double slack = tolerance_of(surface, other).length;
  const Ring& ring = other.rings.front();
  return std::any_of(ring.begin(), ring.end(), [&](const Vec2& p) {
    return side * surface.frame.height(other.frame.to_space(p)) > slack;
  });
}

class LightSearch {
 public:
  LightSearch(const SoundScene& scene, const PartSides& sides) : scene_(scene) {
    for (const int s : sides.fronts) {
      const Material& material = scene.materials[at(scene.surfaces[at(s)].material)];
      if ((material.exitance > 0).any())
        senders_.push_back(s);
      else if ((material.rho > 0).any())
        dark_.push_back(s);
    }
  }

  /// Of these backs, the first that light gets to; −1 if there is none, nothing if it takes too
  /// long to tell.
  std::optional<int> first_reached(const std::vector<int>& backs) {
    for (std::size_t k = 0; k < senders_.size(); ++k) {
      const int sender = senders_[k];
      for (const int s : backs)
        if (reaches(sender, s, -1)) return s;
      const auto is_dark = [&](int s) { return !reaches(sender, s, 1); };
      const auto lit = std::stable_partition(dark_.begin(), dark_.end(), is_dark);
      senders_.insert(senders_.end(), lit, dark_.end());
      dark_.erase(lit, dark_.end());
      if (pairs_ > most_pairs) return std::nullopt;
    }
    return -1;
  }

 private:
  bool reaches(int sender, int receiver, double side) {
    ++pairs_;
    const Surface &from = scene_.surfaces[at(sender)], &to = scene_.surfaces[at(receiver)];
    return sender != receiver && has_part(from, 1, to) && has_part(to, side, from);
  }

  const SoundScene& scene_;
  std::vector<int> senders_;
  std::vector<int> dark_;  ///< would reflect, if anything were to reach them
  long pairs_ = 0;
};

}  // namespace

int first_lit_back(const SoundScene& scene, const PartSides& sides) {
  if (sides.backs.empty()) return -1;
  return LightSearch(scene, sides).first_reached(sides.backs).value_or(sides.backs.front());
}

}  // namespace halfshade
