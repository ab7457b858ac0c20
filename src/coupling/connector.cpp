#include "dovetail/coupling/connector.hpp"

#include "dovetail/core/error.hpp"

namespace dovetail::coupling {

std::unique_ptr<dem::Term> Connector::clone() const {
  throw InputError("the copy of \"" + name() + "\" would act on the same solid", "copy of a coupled model",
                   "save the run and load it into one that is set up like it");
}

}  // namespace dovetail::coupling
