// Hertz with Mindlin's friction, rolling and twisting resistance.
#include "compile_law.hpp"

namespace dovetail::dem::detail {

DOVETAIL_COMPILE_LAW(ContactLaw<HertzDashpot, MindlinSpring, RollingAndTwisting>);
DOVETAIL_COMPILE_LAW(ContactLaw<HertzDashpot, MindlinSpring, RollingAndTwisting, Cohesion>);

}  // namespace dovetail::dem::detail
