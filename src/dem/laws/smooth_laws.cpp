// Laws without friction.
#include "compile_law.hpp"

namespace dovetail::dem::detail {

DOVETAIL_COMPILE_LAW(ContactLaw<LinearSpringDashpot>);
DOVETAIL_COMPILE_LAW(ContactLaw<LinearSpringDashpot, NoTangential, NoRolling, Cohesion>);
DOVETAIL_COMPILE_LAW(ContactLaw<HertzDashpot>);
DOVETAIL_COMPILE_LAW(ContactLaw<HertzDashpot, NoTangential, NoRolling, Cohesion>);
DOVETAIL_COMPILE_LAW(ContactLaw<ElasticPlastic>);
DOVETAIL_COMPILE_LAW(ContactLaw<ElasticPlastic, NoTangential, NoRolling, Cohesion>);

}  // namespace dovetail::dem::detail
