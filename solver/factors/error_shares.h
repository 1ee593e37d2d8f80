#pragma once

#include "solver/factors/factor_scene.h"
#include "solver/factors/pair_search.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

namespace halfshade {

/// What the partial pairs of an entry are off by together. As a rule each is off by a tenth of what
/// it claims, and not all in the same way: so of n the claims add up like n^(3/4) of them, which
/// holds for up to 10⁴ that are all off in the same way, too, as copies are.
class JointError {
 public:
  static constexpr double power = 4. / 3;

  void add(double error) { powers_ += std::pow(error, power); }
  double bound() const { return std::pow(powers_, 1 / power); }

 private:
  double powers_ = 0;
};

/// How errors are shared out among partial pairs so that no entry is off by more than the
/// tolerance, and rows, whose entries are off independently of each other, hardly by more. At first
/// all pairs of an entry get as much; what those that are done leave goes to the others.
class ErrorShares {
 public:
  /// `scene` must outlive it; `tolerance` is that of form factors.
  ErrorShares(const FactorScene& scene, const std::vector<std::vector<SightPair>>& pairs,
              double tolerance);

  /// Rows of an entry, the same from both sides; surroundings and backs are one.
  static std::array<int, 2> entry_of(int row, int other);

  /// Mutual area that a pair may be off by, whatever the others are.
  double even_share(int row, int other) const;
  /// What so many pairs of an entry together may be.
  double joint_share(int row, int other, std::size_t pairs) const {
    return std::pow(static_cast<double>(pairs), 1 / JointError::power) * even_share(row, other);
  }
  /// Whether its entry has so many pairs that less to do for some means more for others.
  bool is_shared(int row, int other) const;

  /// A pair is done, and off by no more than this.
  void spend(int row, int other, double error);

  /// What is left is shared out again: every pair that is not done claims something. `need` is what
  /// it is off by after few points, times their number.
  void forget_claims();
  void claim(int row, int other, double need);
  /// Of a pair that claimed: no less than its even share.
  double share(int row, int other, double need) const;

 private:
  struct Entry {
    double pairs = 0;
    // To JointError::power:
    double spent = 0;  ///< by pairs that are done
    double left = 0;   ///< pairs that claimed, and the sum of their claims
    double claims = 0;
  };

  Entry& entry(int row, int other) {
    return entries_[at(entry_of(row, other)[0])][entry_of(row, other)[1]];
  }
  const Entry& entry(int row, int other) const;
  /// Mutual area that an entry may be off by.
  double allowed(int row, int other) const;
  /// Which part of that a pair may be, for the sake of the entry, and at most for that of rows.
  double parts_of_entry(int row, int other) const;
  double parts_of_rows(int row, int other) const;

  const FactorScene& scene_;
  double tolerance_;
  std::vector<double> of_row_;  // pairs
  std::vector<std::map<int, Entry>> entries_;
};

}  // namespace halfshade
