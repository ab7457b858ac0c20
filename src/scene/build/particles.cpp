// Spheres of a scene.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/io/csv_table.hpp"
#include "grains_of_codes.hpp"
#include "keys/advice.hpp"
#include "parts.hpp"
#include "run/checkpoints.hpp"
#include "sizes.hpp"
#include "sphere_table.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

using Target = GroupTarget;

geometry::Periodicity spaceOf(const geometry::Box& box, const Scene& scene) {
  geometry::Periodicity space{box, {}};
  if (!scene.periodic) return space;
  for (int k = 0; k < 3; ++k) {
    const auto a = static_cast<std::size_t>(k);
    const geometry::Box& all = scene.periodic->box;
    space.axes[a] = scene.periodic->axes[a] && box.lower[k] == all.lower[k] && box.upper[k] == all.upper[k];
  }
  return space;
}

/// @param length  edge of the cube of which each holds one sphere
void requireMemoryIn(const geometry::Box& box, double length) {
  const Vec3 edges = box.upper - box.lower;
  requireMemory(edges.x / length * (edges.y / length) * (edges.z / length), "spheres", BytesPer::grain,
                "take larger ones, or a smaller box");
}

void add(const Target& to, const Lattice& lattice) {
  requireMemoryIn(lattice.box, lattice.distance.value_or(2.0 * lattice.radius));
  const auto kind = static_cast<dem::Lattice>(lattice.kind);
  dem::addPacking(
      to.grains.particles,
      dem::fillWithLattice(kind, lattice.box, lattice.radius, lattice.distance.value_or(2.0 * lattice.radius),
                           spaceOf(lattice.box, to.scene).axes),
      {lattice.density}, to.group.velocity);
}

/// What is filled in place of a box; of no volume if it is a box.
dem::PackingRoom roomOf(const Target& to, const RandomPacking& packing) {
  if (packing.box.has_value() + packing.cylinder.has_value() + packing.surface.has_value() != 1)
    throw InputError("a packing fills one region", "", "give one of box, cylinder and surface");
  if (packing.cylinder)
    return dem::cylinderRoom(packing.cylinder->point, packing.cylinder->axis, packing.cylinder->radius,
                             packing.cylinder->length);
  if (!packing.surface) return {};
  const TriangleFiles& from = *packing.surface;
  return dem::roomInside(surfaceOf(from, geometry::ClosedPatches::turn, to.notes));
}

/// The largest number of spheres that does not jam; 0 if one does.
std::int64_t numberThatFits(const dem::Sizes& sizes, const geometry::Periodicity& space, dem::GrowthOptions settings) {
  std::int64_t fits = 0, jams = settings.number;
  while (jams - fits > 1) {
    settings.number = fits + (jams - fits) / 2;
    dem::PackingReport report;
    dem::growPacking(sizes, space, settings, report);
    (report.reached ? fits : jams) = settings.number;
  }
  return fits;
}

[[noreturn]] void refuseJammed(const dem::Sizes& sizes, const geometry::Periodicity& space,
                               const dem::GrowthOptions& settings, const dem::PackingReport& report) {
  if (settings.number == 0)
    throw InputError("the packing jams at the solid fraction " + formatNumber(report.solidFraction), "",
                     "give a solid_fraction below that");
  constexpr std::int64_t few = 200;  // that are tried one by one; more are as dense as these were when they jammed
  const double estimate = static_cast<double>(settings.number) * report.solidFraction / settings.solidFraction;
  const std::string most = settings.number <= few ? std::to_string(numberThatFits(sizes, space, settings))
                                                  : "about " + formatNumber(std::floor(estimate));
  throw InputError("the region holds " + most + " such spheres, not " + std::to_string(settings.number), "",
                   "give a smaller number, smaller spheres or a larger region");
}

void add(const Target& to, const RandomPacking& packing) {
  const dem::Sizes sizes = sizesOf(packing.radius);
  dem::validate(sizes);
  if (packing.number > 0 && packing.solidFraction)
    throw InputError("both a number and a solid_fraction are given", "", "leave one of them out");
  const dem::PackingRoom room = roomOf(to, packing);
  const geometry::Periodicity space =
      packing.box ? spaceOf(*packing.box, to.scene) : geometry::Periodicity{room.box, {}};
  const double volume = room.volume > 0.0 ? room.volume : space.length(0) * space.length(1) * space.length(2);
  const double wanted = packing.number > 0 ? static_cast<double>(packing.number) * dem::meanVolume(sizes) / volume
                                           : packing.solidFraction.value_or(0.55);
  if (!(wanted < 0.74))
    throw InputError(std::to_string(packing.number) + " spheres would fill " + rounded(wanted) + " of the region", "",
                     "about " + formatNumber(std::floor(0.6 * volume / dem::meanVolume(sizes))) +
                         " fit: give a smaller number, smaller spheres or a larger region");
  requireMemory(volume * wanted / dem::meanVolume(sizes), "spheres", BytesPer::grain,
                "take larger ones, or a smaller box");
  const dem::GrowthOptions settings{.solidFraction = wanted,
                                    .number = packing.number,
                                    .room = room,
                                    .overlap = packing.overlap,
                                    .seed = static_cast<std::uint64_t>(packing.seed)};
  dem::PackingReport report;
  const dem::Packing spheres = dem::growPacking(sizes, space, settings, report);
  if (!report.reached) refuseJammed(sizes, space, settings, report);
  to.notes.push_back("Random packing of " + std::to_string(spheres.centre.size()) + " spheres: solid fraction " +
                     formatNumber(report.solidFraction) + ", largest overlap " + formatNumber(report.largestOverlap) +
                     " radii.");
  if (packing.number == 0 && report.solidFraction < 0.8 * wanted)
    to.notes.push_back("WARNING: The box of the packing holds spheres for a solid fraction of " +
                       rounded(report.solidFraction) + ", not of " + formatNumber(wanted) +
                       ": give it smaller grains, or a larger box.");
  dem::addPacking(to.grains.particles, spheres, {packing.density}, to.group.velocity);
}

void add(const Target& to, const MovingSphere& sphere, double density) {
  dem::Particles& particles = to.grains.particles;
  dem::addParticle(particles, sphere.at, to.group.velocity + sphere.velocity, sphere.radius, dem::Density{density});
  if (norm(sphere.spin) == 0.0) return;
  dem::switchOnRotation(particles);
  particles.omega.back() = sphere.spin;
}
void add(const Target& to, const SphereList& list) {
  for (const MovingSphere& sphere : list.spheres) add(to, sphere, list.density);
}

void add(const Target& to, const SphereFrame& from) {
  const std::vector<MovingSphere> spheres = readSpheres(from.file);
  if (spheres.empty()) throw InputError("the frame has no grains", from.file, "give one with grains, or leave it out");
  add(to, SphereList{{from.density}, spheres});
}

void add(const Target& to, const GrainsOfState& from) {
  if (to.grains.particles.size() > 0)
    throw InputError("particles from a state must come first in the list \"particles\"", "", "put them first");
  const Checkpoint checkpoint = loadCheckpoint(from.file);
  dem::loadGrains(coupling::particlesOf(checkpoint.state), from.file, to.grains);
  for (Vec3& v : to.grains.particles.v) v += to.group.velocity;
  to.notes.push_back(std::to_string(to.grains.particles.size()) + " grains are those of a run at " +
                     formatNumber(checkpoint.time) + " s.");
}

void add(const Target& to, const SphereFile& from) {
  for (const SphereOfTable& sphere : spheresOfTable(from.file))
    atPlace(from.file + ", line " + std::to_string(sphere.line), [&] { add(to, sphere, from.density); });
}

void add(const Target& to, const GrainsOfLammps& from) {
  const auto units = static_cast<grain_io::Units>(from.units);
  addGrainsOfCode(to, from, grain_io::readLammps(from.file, units, from.frame));
}
void add(const Target& to, const GrainsOfYade& from) { addGrainsOfCode(to, from, grain_io::readYade(from.file)); }
void add(const Target& to, const GrainsOfMercury& from) {
  addGrainsOfCode(to, from, grain_io::readMercury(from.file, from.frame));
}

void addSpin(dem::Particles& particles, std::size_t first, const Vec3& spin) {
  if (norm(spin) == 0.0) return;
  dem::switchOnRotation(particles);
  for (std::size_t i = first; i < particles.size(); ++i) particles.omega[i] += spin;
}

}  // namespace

void setContactMaterial(dem::Particles& particles, std::size_t first, int row) {
  if (row == 0) return;
  particles.material.resize(particles.size(), 0);
  std::fill(particles.material.begin() + static_cast<std::ptrdiff_t>(first), particles.material.end(),
            static_cast<std::uint8_t>(row));
}

Groups addParticles(dem::Model& grains, const Scene& scene, std::vector<std::string>& notes) {
  Groups groups;
  for (const Particles& group : scene.particles)
    atPlace(group.where, [&] {
      const std::size_t first = grains.particles.size();
      std::visit([&](const auto& source) { add({grains, group, scene, notes}, source); }, group.from);
      setContactMaterial(grains.particles, first, contactRow(scene, group.contactMaterial));
      addSpin(grains.particles, first, group.spin);
      if (group.name.empty()) return;
      const auto& ids = grains.particles.id;
      const bool isNew =
          groups.try_emplace(group.name, ids.begin() + static_cast<std::ptrdiff_t>(first), ids.end()).second;
      if (!isNew) throw InputError("there are two groups \"" + group.name + "\"", "", "give one another name");
    });
  return groups;
}

}  // namespace dovetail::scene
