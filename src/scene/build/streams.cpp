// Clumps, insertions and outlets of a scene.
#include "dovetail/dem/setup/streams.hpp"

#include "dovetail/dem/bodies/body_term.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

void add(dem::Model& grains, const Clump& clump, const Scene& scene) {
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (const Sphere& sphere : clump.spheres) {
    centres.push_back(sphere.at);
    radii.push_back(sphere.radius);
  }
  const std::size_t first = grains.particles.size();
  dem::addClump(grains, dem::makeClumpShape(centres, radii, {clump.density}), clump.at, {}, clump.velocity, clump.spin);
  setContactMaterial(grains.particles, first, contactRow(scene, clump.contactMaterial));
}

void add(dem::Model& grains, const Insertion& insertion, const Scene& scene) {
  if (insertion.numberPerSecond.has_value() == insertion.massPerSecond.has_value())
    throw InputError("an insertion needs one rate", "", "give number_per_second or mass_per_second");
  dem::addInsertion(grains, {.region = insertion.region,
                             .sizes = dem::UniformSizes{insertion.radius.smallest, insertion.radius.largest},
                             .density = {insertion.density},
                             .velocity = insertion.velocity,
                             .material = contactRow(scene, insertion.contactMaterial),
                             .numberPerSecond = insertion.numberPerSecond.value_or(0.0),
                             .massPerSecond = insertion.massPerSecond.value_or(0.0),
                             .seed = static_cast<std::uint64_t>(insertion.seed)});
}

}  // namespace

void addClumpsAndStreams(dem::Model& grains, const Scene& scene) {
  for (const Clump& clump : scene.clumps) atPlace(clump.where, [&] { add(grains, clump, scene); });
  for (const Insertion& insertion : scene.insertions) atPlace(insertion.where, [&] { add(grains, insertion, scene); });
  for (const Outlet& outlet : scene.outlets) atPlace(outlet.where, [&] { dem::addOutlet(grains, outlet.region); });
}

}  // namespace dovetail::scene
