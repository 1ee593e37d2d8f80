#pragma once

#include "solver/reflected/final_pass.h"
#include "solver/reflected/reflection_estimate.h"

#include <vector>

namespace halfshade {

/// Of a goal: less noise is not worth a pass.
inline constexpr double least_noise = 0.25;

/// What a pass is to leave of `noise`, so that elements, noise and twice the deviation of the
/// estimate are a little less than `goal`, or `enough` if that is more.
double noise_after_pass(const ReflectionEstimate& estimate, double noise, double goal,
                        double enough);

/// What rays that are not kept have found, for as long as their elements are there: by how much K
/// is more than the kept rays say. That hardly changes with what leaves.
class RayPasses {
 public:
  int count() const { return count_; }

  /// What the rays from a node of each element so far are as good as at once, see rays_as_good_as;
  /// `kept` are there anyway.
  std::vector<double> sent(const ReflectedMesh& mesh, std::vector<double> kept) const;

  /// Corrects what the kept rays say, and its noise.
  void correct(const ReflectedMesh& mesh, ElementField& rest, FieldNoise& noise) const;

  /// Adds a pass where it has strata. `kept` and `noise` are what the kept rays say of the same
  /// light. What was known counts as what noise there is in all of it allows: that of each element
  /// is not known well enough, and not independent of what was found there.
  void add(const ReflectedMesh& mesh, const FinalPass& pass, const std::vector<int>& strata,
           const std::vector<double>& weight, const ElementField& kept, const FieldNoise& noise);

 private:
  struct OfTriangle {
    ChannelArray more;  ///< than the kept rays say
    FieldNoise::value_type noise{};
    double rays = 0;  ///< likewise, from a node
    int passes = 0;
  };
  /// None if it was not there when the pass was made, or had another order.
  const OfTriangle* find(const ReflectedMesh& mesh, int element) const;

  std::vector<OfTriangle> of_triangle_;
  int count_ = 0;
};

}  // namespace halfshade
