#pragma once

#include "solver/exchange/exchange.h"

#include <Eigen/IterativeLinearSolvers>

namespace halfshade {
class ScaledOperator;
}

namespace Eigen::internal {
template <>
struct traits<halfshade::ScaledOperator> : traits<Eigen::SparseMatrix<double>> {};
}  // namespace Eigen::internal

namespace halfshade {

/// out = M·in by rows on all threads; `weight` ≠ 0 marks the rows wanted (the others of `out`
/// become 0).
void multiply(const ExchangeMatrix& matrix, const Eigen::VectorXd& in,
              const Eigen::VectorXd& weight, Eigen::VectorXd& out);

/// out = M·in for all rows.
Eigen::VectorXd multiply(const ExchangeMatrix& matrix, const Eigen::VectorXd& in);

/// The matrix I + sign·W M W with W diagonal, never formed: what conjugate gradients iterate on.
/// Rows and columns with weight 0 are those of the identity and cost nothing.
class ScaledOperator : public Eigen::EigenBase<ScaledOperator> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = true
  };

  ScaledOperator(const ExchangeMatrix& matrix, Eigen::VectorXd weight, double sign)
      : matrix_(&matrix), weight_(std::move(weight)), sign_(sign) {}

  Eigen::Index rows() const { return matrix_->rows(); }
  Eigen::Index cols() const { return matrix_->cols(); }

  Eigen::VectorXd apply(const Eigen::VectorXd& x) const {
    Eigen::VectorXd product(rows());
    multiply(*matrix_, weight_.cwiseProduct(x), weight_, product);
    return x + sign_ * weight_.cwiseProduct(product);
  }

  template <typename Rhs>
  Eigen::Product<ScaledOperator, Rhs, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Rhs>& x) const {
    return {*this, x.derived()};
  }

 private:
  const ExchangeMatrix* matrix_;
  Eigen::VectorXd weight_;
  double sign_;
};

/// Conjugate gradients on a matrix whose diagonal is 1 by construction; that is what
/// preconditioning with the diagonal of the unscaled matrix amounts to.
using ConjugateGradients = Eigen::ConjugateGradient<ScaledOperator, Eigen::Lower | Eigen::Upper,
                                                    Eigen::IdentityPreconditioner>;

}  // namespace halfshade

namespace Eigen::internal {
template <typename Rhs>
struct generic_product_impl<halfshade::ScaledOperator, Rhs, SparseShape, DenseShape, GemvProduct>
    : generic_product_impl_base<halfshade::ScaledOperator, Rhs,
                                generic_product_impl<halfshade::ScaledOperator, Rhs>> {
  template <typename Dest>
  static void scaleAndAddTo(Dest& out, const halfshade::ScaledOperator& op, const Rhs& x,
                            double alpha) {
    out += alpha * op.apply(x);
  }
};
}  // namespace Eigen::internal
