// Linear springs with friction, rolling and twisting resistance.
#include "compile_law.hpp"

namespace dovetail::dem::detail {

DOVETAIL_COMPILE_LAW(ContactLaw<LinearSpringDashpot, TangentialSpring, RollingAndTwisting>);
DOVETAIL_COMPILE_LAW(ContactLaw<LinearSpringDashpot, TangentialSpring, RollingAndTwisting, Cohesion>);

}  // namespace dovetail::dem::detail
