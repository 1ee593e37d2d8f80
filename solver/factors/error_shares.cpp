#include "solver/factors/error_shares.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// What entries are off by adds up like the root of their number, if there are many; of that,
/// estimates of lattices are at least this many times as much. Where there are few, they count as
/// more.
double parts_of_row(double entries) {
  constexpr double few = 0.25, many = 0.5, overestimated = 5.5;
  return std::max(std::pow(entries, few), std::pow(entries, many) / overestimated);
}

constexpr double power = JointError::power;

/// Points go like `need` over the share, about. The sum of them is least, where the sum of powers
/// of shares is given, if these go like this.
double claim_of(double need) { return std::pow(need, power / (1 + power)); }

}  // namespace

ErrorShares::ErrorShares(const FactorScene& scene, const std::vector<std::vector<SightPair>>& pairs,
                         double tolerance)
    : scene_(scene), tolerance_(tolerance), of_row_(at(scene.rows())), entries_(at(scene.rows())) {
  for (std::size_t a = 0; a < pairs.size(); ++a)
    for (const SightPair& pair : pairs[a]) {
      if (pair.sight != Sight::partial) continue;
      const int row = scene.row[a], other = scene.row[at(pair.other)];
      of_row_[at(row)] += 1;
      if (other >= 0 && other != row) of_row_[at(other)] += 1;
      entry(row, other).pairs += 1;
    }
}

std::array<int, 2> ErrorShares::entry_of(int row, int other) {
  return other < 0 ? std::array{row, -1} : std::array{std::min(row, other), std::max(row, other)};
}

const ErrorShares::Entry& ErrorShares::entry(int row, int other) const {
  return entries_[at(entry_of(row, other)[0])].at(entry_of(row, other)[1]);
}

double ErrorShares::allowed(int row, int other) const {
  const double area = scene_.areas[at(row)];
  if (other == row) return tolerance_ * area / 2;  // its pairs are seen from both sides
  return tolerance_ * (other < 0 ? area : std::min(area, scene_.areas[at(other)]));
}

double ErrorShares::parts_of_entry(int row, int other) const {
  return std::pow(entry(row, other).pairs, 1 / power);
}

double ErrorShares::parts_of_rows(int row, int other) const {
  const double in_row = of_row_[at(row)];
  return std::max(1., parts_of_row(other < 0 ? in_row : std::max(in_row, of_row_[at(other)])));
}

double ErrorShares::even_share(int row, int other) const {
  return allowed(row, other) / std::max(parts_of_entry(row, other), parts_of_rows(row, other));
}

bool ErrorShares::is_shared(int row, int other) const {
  return parts_of_entry(row, other) > parts_of_rows(row, other);
}

void ErrorShares::spend(int row, int other, double error) {
  entry(row, other).spent += std::pow(error, power);
}

void ErrorShares::forget_claims() {
  for (auto& of_row : entries_)
    for (auto& [other, entry] : of_row) entry.left = entry.claims = 0;
}

void ErrorShares::claim(int row, int other, double need) {
  Entry& own = entry(row, other);
  own.left += 1;
  own.claims += claim_of(need);
}

double ErrorShares::share(int row, int other, double need) const {
  const double even = even_share(row, other), all = allowed(row, other);
  if (!is_shared(row, other)) return even;
  const Entry& own = entry(row, other);
  if (!(own.claims > 0)) return even;
  const double of_all = std::pow(all, power), of_even = std::pow(even, power);
  const double more = std::max(0., of_all - own.spent - own.left * of_even);
  return std::clamp(std::pow(of_even + more * claim_of(need) / own.claims, 1 / power), even,
                    std::max(even, all / parts_of_rows(row, other)));
}

}  // namespace halfshade
