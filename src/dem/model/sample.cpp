#include "dovetail/dem/model/sample.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/walls.hpp"

namespace dovetail::dem {

ContactSample sampleContacts(const Model& m) {
  if (m.particles.size() == 0) return {};
  if (m.forcesOf != m.particles.revision)
    throw InputError("forces have not been found yet", "sample of contacts", "call findForces, or take a step, before");
  ContactSample sample = m.laws->sample(m.particles, m.pairs);
  for (const PrimitiveWallTerm* term : m.terms.all<PrimitiveWallTerm>())
    addWallContacts(m.particles, term->wall, sample);
  for (const MeshWallTerm* term : m.terms.all<MeshWallTerm>())
    addWallContacts(m.particles, term->mesh.wall, term->mesh.contacts, sample);
  return sample;
}

}  // namespace dovetail::dem
