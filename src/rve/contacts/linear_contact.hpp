// A contact's force and moments, linearised.
#pragma once

#include <Eigen/Core>

#include "touching.hpp"

namespace dovetail::rve {

/// What of a contact the linear network knows.
struct Linearisation {
  bool slips = false;     ///< springs at the limit of friction slip on
  bool prestress = true;  ///< the forces that contacts carry turn with them
};

/// Rows: force on i, moment on i, moment on j. Columns: change of the branch b, turns of i and of j. N/m, N, N m.
using ContactMatrix = Eigen::Matrix<double, 9, 9>;

ContactMatrix linearised(const Rve& cell, const Touch& touch, const Linearisation& what);

}  // namespace dovetail::rve
