#include "dovetail/surface/solid_surface.hpp"

#include <algorithm>
#include <utility>

#include "dovetail/core/error.hpp"

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
                       "give all the same rule for edges (\"edges\")");
    if (own.margin > 0.0 && (all.margin == 0.0 || own.margin < all.margin)) all.margin = own.margin;
  }
  return all;
}

}  // namespace

SolidSurface::SolidSurface(std::span<const SurfacePart> parts) : whole_(skinOf(parts), optionsOf(parts)) {
  int facets = 0;
  for (const SurfacePart& part : parts) {
    first_.push_back(std::exchange(facets, facets + static_cast<int>(part.coupling->wall().facets.size())));
    alike_ = alike_ && sameAnswer(part.answer(), parts[0].answer());
  }
}

void SolidSurface::find(std::span<const SurfacePart> parts, const dem::Particles& particles, std::span<const Vec3> u,
                        std::span<const Vec3> v, const ExchangeOptions& options) {
  double reach = 0.0;
  for (const SurfacePart& part : parts) reach = std::max(reach, part.laws->reach());
  whole_.find(particles, u, v, reach, options);
}

void SolidSurface::addSeam(std::span<const SurfacePart> parts, const ExchangeOptions& options,
                           std::vector<dem::WallAtSeam>& seams) {
  if (alike_) whole_.addSeam(parts[0].answer(), options, seams);
}

void SolidSurface::handOut(std::span<const SurfacePart> parts, const dem::Particles& particles, std::span<const Vec3> u,
                           std::span<const Vec3> v, const ExchangeOptions& options) {
  whole_.weigh(particles, options);
  for (std::size_t p = 0; p < parts.size(); ++p)
    parts[p].coupling->take(whole_, first_[p], parts[p].laws->reach(), u, v);
}

dem::ContactWork SolidSurface::answer(std::span<const SurfacePart> parts, dem::Particles& particles,
                                      std::span<const Vec3> u, double dt, const ExchangeOptions& options) {
  dem::ContactWork work;
  for (const SurfacePart& part : parts) work += part.coupling->answer(particles, u, *part.laws, dt, options);
  if (!options.fraction.empty()) gatherEnergies(parts);
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
  whole_.fractions_.book(particle, energy);
}

}  // namespace dovetail::surface
