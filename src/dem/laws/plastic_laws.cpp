// Elastic–plastic grains with friction.
#include "compile_law.hpp"

namespace dovetail::dem::detail {

DOVETAIL_COMPILE_LAW(ContactLaw<ElasticPlastic, TangentialSpring>);
DOVETAIL_COMPILE_LAW(ContactLaw<ElasticPlastic, TangentialSpring, NoRolling, Cohesion>);

}  // namespace dovetail::dem::detail
