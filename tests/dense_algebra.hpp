// Eigen's dense algebra; what is long to compile of it is compiled once, in dense_algebra.cpp.
#pragma once

#include <Eigen/Dense>

namespace Eigen {
extern template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(const EigenBase<MatrixXd>&,
                                                                                            int);
extern template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
}  // namespace Eigen
