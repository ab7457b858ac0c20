// Clumps, insertions and outlets of a scene.
#include "dovetail/dem/setup/streams.hpp"

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "parts.hpp"
#include "sizes.hpp"

namespace dovetail::scene {

namespace {

/// @return the ids of its members
std::vector<std::int64_t> add(dem::Model& grains, const Clump& clump, const Scene& scene) {
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (const Sphere& sphere : clump.spheres) {
    centres.push_back(sphere.at);
    radii.push_back(sphere.radius);
  }
  const std::size_t first = grains.particles.size();
  dem::addClump(grains, dem::makeClumpShape(centres, radii, {clump.density}), clump.at, {}, clump.velocity, clump.spin);
  setContactMaterial(grains.particles, first, contactRow(scene, clump.contactMaterial));
  return {grains.particles.id.begin() + static_cast<std::ptrdiff_t>(first), grains.particles.id.end()};
}

void requireOneOfEach(const Insertion& insertion) {
  if (insertion.numberPerSecond.has_value() + insertion.massPerSecond.has_value() + insertion.replacesLeavers != 1)
    throw InputError("an insertion needs one rate", "",
                     "give one of number_per_second, mass_per_second and replaces_leavers");
  if (insertion.radius.has_value() == !insertion.clumps.empty())
    throw InputError(insertion.radius ? "an insertion has a radius and clumps" : "an insertion has no grains", "",
                     "give it radius, for spheres, or clumps");
  if (insertion.until && *insertion.until <= insertion.from)
    throw InputError("the insertion ends at " + formatNumber(*insertion.until) + " s, and begins at " +
                         formatNumber(insertion.from) + " s",
                     "", "give \"until\" a time after \"from\"");
}

void add(dem::Model& grains, const Insertion& insertion, const Scene& scene) {
  requireOneOfEach(insertion);
  dem::InsertionOptions options{.region = insertion.region,
                                .sizes = insertion.radius ? sizesOf(*insertion.radius) : dem::Sizes{},
                                .density = {insertion.density},
                                .shapes = shapesOf(insertion),
                                .velocity = insertion.velocity,
                                .spin = insertion.spin,
                                .material = contactRow(scene, insertion.contactMaterial),
                                .numberPerSecond = insertion.numberPerSecond.value_or(0.0),
                                .massPerSecond = insertion.massPerSecond.value_or(0.0),
                                .replacesLeavers = insertion.replacesLeavers,
                                .from = insertion.from,
                                .seed = static_cast<std::uint64_t>(insertion.seed)};
  if (insertion.until) options.until = *insertion.until;
  if (insertion.totalNumber > 0) options.totalNumber = insertion.totalNumber;
  if (insertion.totalMass) options.totalMass = *insertion.totalMass;
  if (norm(insertion.spin) > 0.0) dem::switchOnRotation(grains.particles);
  dem::addInsertion(grains, options);
}

}  // namespace

void addClumps(dem::Model& grains, const Scene& scene, Groups& groups) {
  const Groups ofParticles = groups;
  for (const Clump& clump : scene.clumps)
    atPlace(clump.where, [&] {
      if (!clump.name.empty() && ofParticles.contains(clump.name))
        throw InputError("there is a group of particles \"" + clump.name + "\"", "", "give the clump another name");
      const std::vector<std::int64_t> members = add(grains, clump, scene);
      if (clump.name.empty()) return;
      std::vector<std::int64_t>& group = groups[clump.name];
      group.insert(group.end(), members.begin(), members.end());
    });
}

void addStreams(dem::Model& grains, const Scene& scene) {
  for (const Insertion& insertion : scene.insertions) atPlace(insertion.where, [&] { add(grains, insertion, scene); });
  for (const Outlet& outlet : scene.outlets) atPlace(outlet.where, [&] { dem::addOutlet(grains, outlet.region); });
}

}  // namespace dovetail::scene
