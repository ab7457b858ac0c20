#include "polar.hpp"

#include <Eigen/LU>
#include <cmath>

namespace dovetail::rve {

namespace {

Eigen::Matrix3d turnInPlane(const Eigen::Matrix3d& G) {
  const double c = G(0, 0) + G(1, 1), s = G(1, 0) - G(0, 1), size = std::hypot(c, s);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << c / size, -s / size, s / size, c / size;
  return turn;
}

/// Newton's iteration for the orthogonal factor (Higham, SIAM J. Sci. Stat. Comput. 7, 1986): the principal stretches
/// go to 1, quadratically, whatever the turn.
Eigen::Matrix3d turnInSpace(const Eigen::Matrix3d& G) {
  Eigen::Matrix3d turn = G;
  for (int k = 0; k < 100; ++k) {
    const Eigen::Matrix3d next = 0.5 * (turn + turn.inverse().transpose());
    const double change = (next - turn).norm();
    turn = next;
    if (!(change > 1e-9)) break;  // what is left is its square
  }
  return turn;
}

}  // namespace

bool isPlane(const Eigen::Matrix3d& G) {
  return G(2, 2) == 1.0 && G(0, 2) == 0.0 && G(1, 2) == 0.0 && G(2, 0) == 0.0 && G(2, 1) == 0.0;
}

Polar polar(const Eigen::Matrix3d& G) {
  const Eigen::Matrix3d turn = isPlane(G) ? turnInPlane(G) : turnInSpace(G);
  const Eigen::Matrix3d stretch = turn.transpose() * G;
  return {turn, 0.5 * (stretch + stretch.transpose())};
}

}  // namespace dovetail::rve
