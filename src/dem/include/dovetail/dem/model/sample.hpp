// Every contact of a model, for fields, averages and files.
#pragma once

#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"

namespace dovetail::dem {

/// Contacts that carry a force, as the last step left them: pairs, then those of the terms, which are walls and
/// the skins of solids in coupled runs, in their order. Bonds have a sample of their own (sampleBonds). For output, not
/// for every step. The sum over a particle's contacts is what they add to its force and torque, but for dashpots of
/// pairs, which see the velocities as they are now: after `close` that is what the step knew to second order.
/// @throws InputError if forces have not been found yet
ContactSample sampleContacts(const Model& m);

}  // namespace dovetail::dem
