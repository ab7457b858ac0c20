// dovetail calibrate, in builds without Ceres.
#include "dovetail/core/error.hpp"
#include "verbs.hpp"

namespace dovetail::program {

Verb addCalibrate(CLI::App& app) {
  CLI::App* const verb = app.add_subcommand("calibrate", "needs a build with Ceres");
  verb->allow_extras();
  return {verb, []() -> int {
            throw InputError("this build has no calibration", "dovetail calibrate",
                             "build it with DOVETAIL_CERES=ON and the package libceres-dev");
          }};
}

}  // namespace dovetail::program
