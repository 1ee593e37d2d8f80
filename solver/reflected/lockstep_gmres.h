#pragma once

#include "solver/elements/solution.h"

#include <functional>
#include <vector>

namespace halfshade {

/// Which rows of an array make up a vector: each group of rows, and each column, is one of its own.
struct RowGroups {
  std::vector<int> of_row;
  Eigen::ArrayXd weight;  ///< of each row in products of vectors, > 0
  int count = 0;
};

/// Products of all vectors of a and b: one row a group.
ChannelArray dots(const RowGroups& groups, const ChannelArray& a, const ChannelArray& b);

struct GmresResult {
  ChannelArray x;
  int iterations = 0;
  double residual = 0;       ///< relative to b, the largest of all systems
  double amplification = 1;  ///< 1 / the smallest singular value seen, of all systems
};

/// Solves A x = b by restarted GMRES (Saad and Schultz 1986), where A does not connect groups nor
/// columns. All systems step together, so that A is applied once for all, but each has a Krylov
/// space of its own, and so its own accuracy. Stops when every residual is `tolerance` of its b, or
/// after the step in which `stopped` became true. If b holds what is no finite number, x is 0 and
/// the residual infinite.
GmresResult gmres(const std::function<ChannelArray(const ChannelArray&)>& A, const ChannelArray& b,
                  const RowGroups& groups, double tolerance, int max_iterations,
                  const std::function<bool()>& stopped = {});

}  // namespace halfshade
