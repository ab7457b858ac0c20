// dovetail calibrate, in builds without Ceres.
#include "dovetail/core/error.hpp"
#include "verbs.hpp"

namespace dovetail::program {

bool calibrate(int, char**) {
  throw InputError("this build has no calibration", "dovetail calibrate",
                   "build it with DOVETAIL_CERES=ON and the package libceres-dev");
}

}  // namespace dovetail::program
