// Elastic–plastic grains with friction, rolling and twisting resistance.
#include "compile_law.hpp"

namespace dovetail::dem::detail {

DOVETAIL_COMPILE_LAW(ContactLaw<ElasticPlastic, TangentialSpring, RollingAndTwisting>);
DOVETAIL_COMPILE_LAW(ContactLaw<ElasticPlastic, TangentialSpring, RollingAndTwisting, Cohesion>);

}  // namespace dovetail::dem::detail
