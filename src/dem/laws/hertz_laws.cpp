// Hertz with Mindlin's friction.
#include "compile_law.hpp"

namespace dovetail::dem::detail {

DOVETAIL_COMPILE_LAW(ContactLaw<HertzDashpot, MindlinSpring>);
DOVETAIL_COMPILE_LAW(ContactLaw<HertzDashpot, MindlinSpring, NoRolling, Cohesion>);

}  // namespace dovetail::dem::detail
