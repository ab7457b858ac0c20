#include "dovetail/surface/solid_surface.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/walls/wall_seams.hpp"

namespace dovetail::surface {

namespace {

Skin skinOf(std::span<const SurfacePart> parts) {
  std::vector<const Skin*> skins;
  for (const SurfacePart& part : parts) skins.push_back(&part.coupling->skin());
  return joined(skins);
}

CouplingOptions optionsOf(std::span<const SurfacePart> parts) {
  CouplingOptions all = parts[0].coupling->options();
  for (const SurfacePart& part : parts) {
    const CouplingOptions& own = part.coupling->options();
    if (own.edges != all.edges)
      throw InputError("two couplings on one solid combine contacts by different rules", "surface of a solid",
                       "give all the same CouplingOptions::edges");
    if (own.margin > 0.0 && (all.margin == 0.0 || own.margin < all.margin)) all.margin = own.margin;
  }
  return all;
}

bool sameAnswer(const SurfacePart& a, const SurfacePart& b) {
  return a.coupling->wall().material == b.coupling->wall().material &&
         (a.laws == b.laws || dem::sameLaws(*a.laws, *b.laws));
}

std::pair<std::size_t, std::size_t> rowsOf(const std::vector<int>& particle, int i) {
  const auto [begin, end] = std::equal_range(particle.begin(), particle.end(), i);
  return {static_cast<std::size_t>(begin - particle.begin()), static_cast<std::size_t>(end - particle.begin())};
}

}  // namespace

SolidSurface::SolidSurface(std::span<const SurfacePart> parts) : whole_(skinOf(parts), optionsOf(parts)), first_{0} {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    first_.push_back(first_.back() + static_cast<int>(parts[p].coupling->wall().facets.size()));
    const auto same =
        std::find_if(parts.begin(), parts.end(), [&](const auto& one) { return sameAnswer(one, parts[p]); });
    alike_.push_back(static_cast<int>(same - parts.begin()));
  }
}

int SolidSurface::partOf(int facet) const {
  return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), facet) - first_.begin()) - 1;
}

dem::ContactWork SolidSurface::exchange(std::span<const SurfacePart> parts, dem::Particles& particles,
                                        std::span<const Vec3> u, std::span<const Vec3> v, double dt,
                                        const ExchangeOptions& options) {
  double reach = 0.0;
  for (const SurfacePart& part : parts) reach = std::max(reach, part.laws->reach());
  whole_.find(particles, u, v, reach, options);
  handOver(parts);
  dem::ContactWork work;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    parts[p].coupling->take(whole_, first_[p], parts[p].laws->reach(), u, v);
    work += parts[p].coupling->answer(particles, u, *parts[p].laws, dt, options);
  }
  if (!options.share.empty()) gatherEnergies(parts);
  return work;
}

void SolidSurface::gatherEnergies(std::span<const SurfacePart> parts) {
  std::vector<std::pair<int, double>> energies;
  for (const SurfacePart& part : parts)
    for (std::size_t c = 0; c < part.coupling->contacts().size(); ++c)
      energies.emplace_back(part.coupling->contacts().particle[c], part.coupling->contacts().energy[c]);
  std::ranges::stable_sort(energies, {}, &std::pair<int, double>::first);
  std::vector<int> particle;
  std::vector<double> energy;
  for (const auto& [i, joules] : energies) {
    particle.push_back(i);
    energy.push_back(joules);
  }
  whole_.shares_.book(particle, energy);
}

/// What contacts remember that have passed from one part to another.
void SolidSurface::handOver(std::span<const SurfacePart> parts) {
  const bool remembered = std::ranges::any_of(
      parts, [](const SurfacePart& part) { return !part.coupling->contacts_.springs.memory.empty(); });
  const std::vector<int>& particle = whole_.contacts_.particle;
  for (std::size_t c = 0, end = 0; remembered && c < particle.size(); c = end) {
    while (end < particle.size() && particle[end] == particle[c]) ++end;
    handOver(parts, c, end);
  }
}

/// Of one particle: a part with more contacts than it remembers takes from those alike that remember more than they
/// have.
void SolidSurface::handOver(std::span<const SurfacePart> parts, std::size_t begin, std::size_t end) {
  const dem::WallContacts& all = whole_.contacts_;
  std::vector<int> wants(parts.size(), 0);
  for (std::size_t c = begin; c < end; ++c) ++wants[static_cast<std::size_t>(partOf(all.facet[c]))];
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto [from, to] = rowsOf(parts[p].coupling->contacts_.springs.particle, all.particle[begin]);
    wants[p] -= static_cast<int>(to - from);
  }
  for (std::size_t c = begin; c < end; ++c) {
    const auto to = static_cast<std::size_t>(partOf(all.facet[c]));
    if (wants[to] <= 0) continue;
    std::size_t best = parts.size(), row = 0;
    double cosine = -2.0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (wants[p] >= 0 || alike_[p] != alike_[to]) continue;
      const dem::WallSprings& springs = parts[p].coupling->contacts_.springs;
      const auto [first, last] = rowsOf(springs.particle, all.particle[c]);
      for (std::size_t o = first; o < last; ++o)
        if (const double here = dot(springs.normal[o], all.normal[c]); here > cosine) {
          cosine = here;
          best = p;
          row = o;
        }
    }
    if (best == parts.size()) continue;
    dem::detail::moveSpring(parts[best].coupling->contacts_.springs, row, parts[to].coupling->contacts_.springs);
    ++wants[best];
    --wants[to];
  }
}

}  // namespace dovetail::surface
