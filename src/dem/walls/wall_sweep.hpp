// Runs a rule over all particles with candidates, in parallel if there are enough of them.
#pragma once

#include <span>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/walls/wall_contacts.hpp"

namespace dovetail::dem {

inline void clearContacts(WallContacts& contacts) {
  contacts.particle.clear();
  contacts.facet.clear();
  contacts.weight.clear();
  contacts.normal.clear();
  contacts.overlap.clear();
  contacts.engagement.clear();
}

inline void addContact(WallContacts& contacts, int particle, int facet, const std::array<double, 3>& weight,
                       const Vec3& normal, double overlap, double engagement) {
  contacts.particle.push_back(particle);
  contacts.facet.push_back(facet);
  contacts.weight.push_back(weight);
  contacts.normal.push_back(normal);
  contacts.overlap.push_back(overlap);
  contacts.engagement.push_back(engagement);
}

inline void appendContacts(WallContacts& contacts, const WallContacts& more) {
  for (std::size_t c = 0; c < more.size(); ++c)
    addContact(contacts, more.particle[c], more.facet[c], more.weight[c], more.normal[c], more.overlap[c],
               more.engagement[c]);
}

/// rule(k, particle, facets, contacts) appends the contacts of one particle, number k of the list.
template <class Rule>
void sweepParticles(const WallCandidates& candidates, WallContacts& contacts, Rule&& rule) {
  constexpr std::size_t grain = 64;
  const std::size_t listed = candidates.particle.size();
  const auto visit = [&](std::size_t begin, std::size_t end, WallContacts& into) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto first = static_cast<std::size_t>(candidates.offsets[k]);
      const auto last = static_cast<std::size_t>(candidates.offsets[k + 1]);
      rule(k, candidates.particle[k], std::span<const int>(candidates.facet).subspan(first, last - first), into);
    }
  };
  clearContacts(contacts);
  if (threads() == 1 || listed <= grain) {
    visit(0, listed, contacts);
  } else {
    std::vector<WallContacts> parts((listed + grain - 1) / grain);
    parallelFor(listed, grain, [&](std::size_t begin, std::size_t end) { visit(begin, end, parts[begin / grain]); });
    for (const WallContacts& part : parts) appendContacts(contacts, part);
  }
  contacts.force.assign(contacts.size(), Vec3{});
}

}  // namespace dovetail::dem
