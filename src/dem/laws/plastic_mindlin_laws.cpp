// Elastic–plastic grains with Mindlin's friction.
#include "compile_law.hpp"

namespace dovetail::dem::detail {

DOVETAIL_COMPILE_LAW(ContactLaw<ElasticPlastic, MindlinSpring>);
DOVETAIL_COMPILE_LAW(ContactLaw<ElasticPlastic, MindlinSpring, NoRolling, Cohesion>);

}  // namespace dovetail::dem::detail
