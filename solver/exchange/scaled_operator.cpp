#include "solver/exchange/scaled_operator.h"

#include "meshing/core/parallel.h"

namespace halfshade {

void multiply(const ExchangeMatrix& matrix, const Eigen::VectorXd& in,
              const Eigen::VectorXd& weight, Eigen::VectorXd& out) {
  const int* const start = matrix.outerIndexPtr();
  const int* const column = matrix.innerIndexPtr();
  const double* const value = matrix.valuePtr();
  parallel_for(static_cast<std::size_t>(matrix.rows()), [&](std::size_t i) {
    double sum = 0;
    if (weight[static_cast<Eigen::Index>(i)] != 0)
      for (int k = start[i]; k < start[i + 1]; ++k) sum += value[k] * in[column[k]];
    out[static_cast<Eigen::Index>(i)] = sum;
  });
}

Eigen::VectorXd multiply(const ExchangeMatrix& matrix, const Eigen::VectorXd& in) {
  Eigen::VectorXd out(matrix.rows());
  multiply(matrix, in, Eigen::VectorXd::Ones(matrix.rows()), out);
  return out;
}

}  // namespace halfshade
