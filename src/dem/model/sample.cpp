#include "dovetail/dem/model/sample.hpp"

#include "dovetail/core/error.hpp"

namespace dovetail::dem {

ContactSample sampleContacts(const Model& m) {
  if (m.particles.size() == 0) return {};
  if (m.forcesOf != m.particles.revision)
    throw InputError("forces have not been found yet", "sample of contacts", "call findForces, or take a step, before");
  ContactSample sample = m.laws->sample(m.particles, m.pairs);
  for (const auto& term : m.terms) term->addContacts(m, sample);
  return sample;
}

}  // namespace dovetail::dem
