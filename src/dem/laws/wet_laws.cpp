// Frictional grains with liquid bridges.
#include "compile_law.hpp"

namespace dovetail::dem::detail {

DOVETAIL_COMPILE_LAW(ContactLaw<LinearSpringDashpot, TangentialSpring, NoRolling, LiquidBridge>);
DOVETAIL_COMPILE_LAW(ContactLaw<LinearSpringDashpot, TangentialSpring, RollingAndTwisting, LiquidBridge>);
DOVETAIL_COMPILE_LAW(ContactLaw<HertzDashpot, MindlinSpring, NoRolling, LiquidBridge>);
DOVETAIL_COMPILE_LAW(ContactLaw<HertzDashpot, MindlinSpring, RollingAndTwisting, LiquidBridge>);

}  // namespace dovetail::dem::detail
