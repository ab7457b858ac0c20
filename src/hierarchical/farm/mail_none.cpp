#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/hierarchical/farm.hpp"
#include "launcher.hpp"
#include "mail.hpp"

namespace dovetail::hierarchical {

Mail* mailOfFarm() { return nullptr; }

void formTeam() {}

bool serveFarm() {
  if (const int ranks = ranksLaunched(); ranks > 1)
    throw InputError("this program was built without ranks, and " + std::to_string(ranks) + " of it would do the same",
                     "mpirun", "start it alone, or build it with DOVETAIL_RANKS=ON");
  return false;
}

}  // namespace dovetail::hierarchical
