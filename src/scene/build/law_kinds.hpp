// Kinds of contact laws that one scene may have.
#pragma once

#include "dovetail/scene/grains.hpp"

namespace dovetail::scene {

/// @throws InputError if one law has another kind of normal force than the first
void requireSameNormal(const ContactLaw& law, const ContactLaw& first);

}  // namespace dovetail::scene
