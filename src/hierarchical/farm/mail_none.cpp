#include <cstdlib>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/hierarchical/farm.hpp"
#include "mail.hpp"

namespace dovetail::hierarchical {

Mail* mailOfFarm() { return nullptr; }

bool serveFarm() {
  const char* const ranks = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (ranks != nullptr && std::string(ranks) != "1")
    throw InputError("this program was built without ranks, and " + std::string(ranks) + " of it would do the same",
                     "mpirun", "start it alone, or build it with DOVETAIL_RANKS=ON");
  return false;
}

}  // namespace dovetail::hierarchical
