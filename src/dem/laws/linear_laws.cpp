// Linear springs with friction.
#include "compile_law.hpp"

namespace dovetail::dem::detail {

DOVETAIL_COMPILE_LAW(ContactLaw<LinearSpringDashpot, TangentialSpring>);
DOVETAIL_COMPILE_LAW(ContactLaw<LinearSpringDashpot, TangentialSpring, NoRolling, Cohesion>);

}  // namespace dovetail::dem::detail
