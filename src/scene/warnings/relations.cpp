// Numbers of a scene that do not go with each other.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "build/extent.hpp"
#include "build/parts.hpp"
#include "build/sizes.hpp"
#include "build/time_functions.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

// ---- waves

void lookAtWaves(const std::string& whose, double modulus, double density, Lines& lines) {
  constexpr double fastest = 2e4, rock = 2500.0;        // diamond, m/s; kg/m3
  const double slowest = density > rock ? 100.0 : 1.0;  // gels and foams are light
  const double speed = std::sqrt(modulus / density);
  if (speed >= slowest && speed <= fastest) return;
  lines.push_back("Waves in " + whose + " travel at " + rounded(speed) +
                  " m/s, and in materials at 10 to 10000 m/s: check "
                  "the units of youngs_modulus (\"2 GPa\") and density (\"2.5 g/cm3\").");
}

// ---- locking

/// Elements of the first order hold their volume at every point, and so hardly deform at all.
void lookAtLocking(const Built& built, const Solid& solid, std::size_t number, Lines& lines) {
  constexpr double incompressible = 0.48;
  double nu = 0.0;
  bool flows = false;
  for (const SolidMaterial* const material : materialsOf(solid)) {
    nu = std::max(nu, poissonRatioOf(*material));
    flows = flows || std::holds_alternative<J2Plastic>(material->law);
  }
  if (nu < incompressible && !flows) return;
  const std::string why =
      flows ? " flows at constant volume (J2)" : " hardly changes its volume (poisson_ratio " + formatNumber(nu) + ")";
  for (const fem::ElementGroup& group : built.meshes[number].groups) {
    const bool bricks = group.shape == fem::ElementShape::hex8, tets = group.shape == fem::ElementShape::tet4;
    if (!tets && !(bricks && solid.formulation == "standard")) continue;
    lines.push_back(
        quoted(solid.name) + why + ", for which " + (tets ? "tet4" : "hex8 (\"standard\")") +
        " elements lock: " + (tets ? "take tet10" : "write \"formulation\": \"enhanced\" or \"mean-dilatation\"") +
        (flows ? "." : ", or a poisson_ratio of 0.45."));
    return;
  }
}

// ---- strength

void lookAtStrength(const std::string& key, const Solid& solid, const SolidMaterial& material, Lines& lines) {
  const auto tell = [&](const char* name, double strength, double modulus) {
    if (strength > modulus)
      lines.push_back(key + "." + name + " is " + rounded(strength) + " Pa, above youngs_modulus, " + rounded(modulus) +
                      " Pa, so that " + quoted(solid.name) +
                      " hardly yields: check the units of both, or take an elastic law.");
  };
  if (const auto* const law = std::get_if<J2Plastic>(&material.law))
    tell("yield_stress", law->yieldStress, law->youngsModulus), tell("hardening", law->hardening, law->youngsModulus);
  if (const auto* const law = std::get_if<DruckerPrager>(&material.law))
    tell("cohesion", law->cohesion, law->youngsModulus);
}

/// What no solid of that modulus withstands.
void lookAtPressures(const std::string& of, const Solid& solid, double modulus, const Scene& scene, Lines& lines) {
  const auto most = [&](const TimeValue& pressure) {
    constexpr int samples = 20;
    const TimeFunction at = functionOf(pressure, scene);
    double found = 0.0;
    for (int n = 0; n <= samples; ++n) found = std::max(found, std::abs(at(durationOf(scene) * n / samples)));
    return found;
  };
  for (std::size_t k = 0; k < solid.loads.size(); ++k)
    if (const auto* const load = std::get_if<PressureLoad>(&solid.loads[k].kind);
        load && !usesPlace(load->pressure) && most(load->pressure) > modulus)
      lines.push_back(of + ".loads." + std::to_string(k) + ".pressure reaches " + rounded(most(load->pressure)) +
                      " Pa, above youngs_modulus of " + quoted(solid.name) + ", " + rounded(modulus) +
                      " Pa: check the units of both.");
}

/// Springs of planes throw a solid out that starts deep behind them.
void lookAtPlanes(const std::string& of, const Solid& solid, const fem::Model& model, double modulus, Lines& lines) {
  constexpr double most = 0.01;
  std::size_t number = 0;
  for (const fem::ContactPlane::Report& report : planeReports(model)) {
    if (report.largestPressure > most * modulus)
      lines.push_back(quoted(solid.name) + " starts " + rounded(report.deepest) + " m behind " + of + ".planes." +
                      std::to_string(number) + ", whose springs press it with " + rounded(report.largestPressure) +
                      " Pa: move either, so that they touch at most.");
    ++number;
  }
}

void lookAtAspects(const std::string& of, const Solid& solid, const fem::SolidMesh& mesh, Lines& lines) {
  constexpr double slender = 60.0;
  const std::vector<fem::ElementQuality> all = fem::measureQuality(mesh, 0).element;
  const auto worst = std::ranges::max_element(all, {}, &fem::ElementQuality::aspect);
  if (worst != all.end() && worst->aspect > slender)
    lines.push_back("Element " + std::to_string(worst - all.begin()) + " of " + quoted(solid.name) + " is " +
                    rounded(worst->aspect) + " times as long as it is high: check the order and units of " + of +
                    "'s box and cells, or mesh it with more elements lengthwise.");
}

// ---- springs of grains

/// A grain of radius r and Young's modulus E has springs of about E r.
void lookAtSpring(const std::string& key, const ContactLaw& law, double radius, Lines& lines) {
  constexpr double hardest = 1e13, stone = 5e10;  // ten times diamond; Pa
  const auto* const linear = std::get_if<LinearContact>(&law.normal);
  if (linear && linear->stiffness > hardest * radius)
    lines.push_back(key + ".stiffness is " + rounded(linear->stiffness) + " N/m, which makes grains of " +
                    rounded(radius) + " m radius as stiff as a material of " + rounded(linear->stiffness / radius) +
                    " Pa (diamond: 1e+12) and the step short: write " + rounded(stone * radius) +
                    " N/m, as of stone, or less.");
}

/// A pendular bridge is a small part of its grains.
void lookAtBridge(const std::string& key, const ContactLaw& law, double radius, Lines& lines) {
  const double grain = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  if (law.liquidBridge && law.liquidBridge->volume > grain)
    lines.push_back(key + ".liquid_bridge.volume is " + rounded(law.liquidBridge->volume) +
                    " m3, more than the smallest grain has (" + rounded(grain) + " m3): write " +
                    rounded(0.01 * grain) + ", a hundredth of it, or check its unit (\"mm3\").");
}

void lookAtSprings(const Scene& scene, const dem::Particles& p, Lines& lines) {
  double smallest = Extent::nowhere;
  for (const double radius : p.radius) smallest = std::min(smallest, radius);
  for (const Insertion& one : scene.insertions) smallest = std::min(smallest, enteringOf(one).smallest);
  const auto lookAt = [&](const std::string& key, const ContactLaw& law) {
    lookAtSpring(key, law, smallest, lines);
    lookAtBridge(key, law, smallest, lines);
  };
  if (scene.contact) lookAt("contact", *scene.contact);
  for (std::size_t k = 0; k < scene.contacts.size(); ++k)
    lookAt("contacts." + std::to_string(k), scene.contacts[k].law);
}

/// Of the slowest of the bonds with that damping, s.
double criticalDamping(const dem::Model& grains, double dampingTime) {
  double longest = 0.0;
  for (const auto* const term : grains.terms.all<dem::BondTerm>())
    for (const dem::Bond& bond : term->bonds.bonds) {
      const double a = grains.particles.mass[static_cast<std::size_t>(bond.i)],
                   b = grains.particles.mass[static_cast<std::size_t>(bond.j)];
      if (bond.dampingTime == dampingTime) longest = std::max(longest, 2.0 * std::sqrt(a * b / (a + b) / bond.normal));
    }
  return longest;
}

void lookAtBonds(const Built& built, const Scene& scene, Lines& lines) {
  constexpr double far = 100.0;
  for (std::size_t k = 0; k < scene.bonds.size(); ++k) {
    const double time = scene.bonds[k].dampingTime, critical = criticalDamping(built.run->grains, time);
    if (time > far * critical && critical > 0.0)
      lines.push_back("bonds." + std::to_string(k) + ".damping_time is " + rounded(time) + " s, " +
                      rounded(time / critical) + " times critical damping: write " + rounded(0.05 * critical) +
                      " s for a damping ratio of 5 %, or check its unit (\"us\").");
  }
}

// ---- sizes

/// The smallest and the largest sphere of a scene, with their keys.
class Radii {
public:
  void add(const std::string& key, double radius) {
    if (radius < least_) least_ = radius, leastKey_ = key;
    if (radius > most_) most_ = radius, mostKey_ = key;
  }
  void add(const std::string& key, const Sizes& sizes) {
    const auto [smallest, largest] = dem::boundsOf(sizesOf(sizes));
    const bool bounded = sizes.distribution.index() < 3;  // by these keys
    add(key + (bounded ? ".radius.smallest" : ".radius"), smallest);
    add(key + (bounded ? ".radius.largest" : ".radius"), largest);
  }
  void add(const std::string& key, const Insertion& one) {
    if (one.radius) return add(key, *one.radius);
    for (std::size_t k = 0; k < one.clumps.size(); ++k)
      for (const Sphere& sphere : one.clumps[k].spheres) add(key + ".clumps." + std::to_string(k), sphere.radius);
  }
  void add(const std::string& key, const Particles& one) {
    if (const auto* const lattice = std::get_if<Lattice>(&one.from)) add(key + ".radius", lattice->radius);
    if (const auto* const packing = std::get_if<RandomPacking>(&one.from)) add(key, packing->radius);
    if (const auto* const list = std::get_if<SphereList>(&one.from))
      for (std::size_t k = 0; k < list->spheres.size(); ++k)
        add(key + ".spheres." + std::to_string(k) + ".radius", list->spheres[k].radius);
  }
  void tell(Lines& lines) const {
    constexpr double far = 1000.0;
    if (most_ > far * least_)
      lines.push_back(leastKey_ + " is " + rounded(least_) + " m and " + mostKey_ + " " + rounded(most_) +
                      " m: the smallest grains set the time step and the largest the range of the pair search. Check "
                      "their units, or leave the smallest grains out.");
  }

private:
  double least_ = Extent::nowhere, most_ = 0.0;
  std::string leastKey_, mostKey_;
};

/// A box that holds one grain of its lattice has another unit than the distance.
void lookAtLattices(const Scene& scene, Lines& lines) {
  for (std::size_t k = 0; k < scene.particles.size(); ++k)
    if (const auto* const lattice = std::get_if<Lattice>(&scene.particles[k].from)) {
      const Vec3 edges = lattice->box.upper - lattice->box.lower;
      const double longest = std::max({edges.x, edges.y, edges.z});
      const double distance = lattice->distance.value_or(2.0 * lattice->radius);
      if (distance > longest)
        lines.push_back("particles." + std::to_string(k) + " is one grain: its distance, " + rounded(distance) +
                        " m, is longer than its box, " + rounded(longest) + " m. Check their units, or give a list.");
    }
}

void lookAtRadii(const Scene& scene, Lines& lines) {
  Radii radii;
  for (std::size_t k = 0; k < scene.particles.size(); ++k)
    radii.add("particles." + std::to_string(k), scene.particles[k]);
  for (std::size_t k = 0; k < scene.insertions.size(); ++k)
    radii.add("insertions." + std::to_string(k), scene.insertions[k]);
  radii.tell(lines);
}

void lookAtSize(const std::string& whose, const std::vector<Vec3>& x, const dem::Particles& p,
                const std::string& remedy, Lines& lines) {
  constexpr double often = 300.0, machine = 20.0;  // m
  if (p.size() == 0 || x.empty()) return;
  Extent body, grains;
  body.add(x);
  grains.add(p.x);
  const double diameter = 2.0 * *std::ranges::min_element(p.radius);
  const double all = grains.size() + diameter, size = body.size();
  if (size > machine && size > often * all)
    lines.push_back(whose + " is " + rounded(size) + " m across, and all grains together " + rounded(all) +
                    " m: " + remedy + ".");
  if (size < diameter)
    lines.push_back(whose + " is " + rounded(size) + " m across, and the smallest grain " + rounded(diameter) +
                    " m: check \"scale\", which is in metres per unit of a file.");
}

void lookAtSizes(const Built& built, const Scene& scene, Lines& lines) {
  const dem::Particles& p = built.run->grains.particles;
  const std::string file = "write \"scale\": 0.001 if its file is in millimetres, or \"100 mm\" for lengths";
  const auto meshes = std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>();
  for (std::size_t w = 0; w < built.walls.size(); ++w)
    for (std::size_t m = built.walls[w].firstMesh; m < built.walls[w].endMesh; ++m)
      lookAtSize("The surface of walls." + std::to_string(w), meshes[m]->mesh.wall.x, p, file, lines);
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    if (const auto* const box = std::get_if<BoxWalls>(&scene.walls[w].shape))
      lookAtSize("The box of walls." + std::to_string(w), {box->box.lower, box->box.upper}, p,
                 "write \"100 mm\" for lengths in millimetres", lines);
  for (std::size_t s = 0; s < scene.solids.size(); ++s)
    lookAtSize("The solid " + quoted(scene.solids[s].name), built.meshes[s].X, p, file, lines);
}

// ---- steps

/// A step that is due to soft springs is long for all else.
void lookAtStep(const Built& built, const Scene& scene, Lines& lines) {
  const dem::Particles& p = built.run->grains.particles;
  const double dt = built.run->dt(), fall = 0.5 * norm(scene.gravity) * dt * dt;
  std::size_t count = 0;
  for (std::size_t i = 0; i < p.size(); ++i) count += norm(p.v[i]) * dt + fall > 0.5 * p.radius[i] ? 1 : 0;
  if (count > 0)
    lines.push_back("In the first step, " + rounded(dt) + " s, " + std::to_string(count) +
                    " grains move by more than half of their radius: take a smaller steps.dt, or stiffer contacts if " +
                    "they set the step.");
}

}  // namespace

void lookAtRelations(const Built& built, const Scene& scene, Lines& lines) {
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    const Solid& solid = scene.solids[s];
    const std::string of = "solids." + std::to_string(s);
    double largest = 0.0;
    const std::vector<const SolidMaterial*> materials = materialsOf(solid);
    for (std::size_t m = 0; m < materials.size(); ++m) {
      if (hasCells(*materials[m])) continue;
      const double modulus = *youngsModulusOf(*materials[m]);
      const std::string region = m > 0 ? " (" + solid.regions[m - 1].elements + ")" : "";
      lookAtWaves(quoted(solid.name) + region, modulus, materials[m]->density, lines);
      lookAtStrength(of + (m > 0 ? ".regions." + std::to_string(m - 1) : "") + ".material", solid, *materials[m],
                     lines);
      largest = std::max(largest, modulus);
    }
    if (largest > 0.0) {
      lookAtPressures(of, solid, largest, scene, lines);
      lookAtPlanes(of, solid, *built.run->solid(s).model, largest, lines);
    }
    lookAtAspects(of, scene.solids[s], built.meshes[s], lines);
    lookAtLocking(built, scene.solids[s], s, lines);
  }
  lookAtSprings(scene, built.run->grains.particles, lines);
  lookAtBonds(built, scene, lines);
  lookAtRadii(scene, lines);
  lookAtLattices(scene, lines);
  lookAtSizes(built, scene, lines);
  lookAtStep(built, scene, lines);
}

}  // namespace dovetail::scene
