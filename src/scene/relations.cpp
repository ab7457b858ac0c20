// Numbers of a scene that do not go with each other.
#include <algorithm>
#include <cmath>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "extent.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

// ---- waves

template <class Law>
double poissonOf(const Law& law) {
  if constexpr (requires { law.poissonRatio; }) return law.poissonRatio;
  return 0.0;
}

void lookAtWaves(const std::string& whose, double modulus, double density, Lines& lines) {
  constexpr double slowest = 1.0, fastest = 2e4;  // soft gels, diamond; m/s
  const double speed = std::sqrt(modulus / density);
  if (speed >= slowest && speed <= fastest) return;
  lines.push_back("Waves in " + whose + " go at " + rounded(speed) +
                  " m/s, and in materials at 10 to 10000 m/s: look at " +
                  "the units of youngs_modulus (\"2 GPa\") and density (\"2.5 g/cm3\").");
}

// ---- locking

/// Elements of the first order hold their volume at every point, and so hardly deform at all.
void lookAtLocking(const Built& built, const Solid& solid, std::size_t number, Lines& lines) {
  constexpr double incompressible = 0.48;
  const double nu = std::visit([](const auto& law) { return poissonOf(law); }, solid.material.law);
  if (nu < incompressible) return;
  for (const fem::CellGroup& group : built.meshes[number].groups) {
    const bool bricks = group.shape == fem::CellShape::hex8, tets = group.shape == fem::CellShape::tet4;
    if (!tets && !(bricks && solid.formulation == "standard")) continue;
    lines.push_back(quoted(solid.name) + " hardly changes its volume (poisson_ratio " + formatNumber(nu) + "), which " +
                    (tets ? "tet4" : "hex8 (\"standard\")") + " take for being rigid: " +
                    (tets ? "take tet10" : "write \"formulation\": \"enhanced\" or \"mean-dilatation\"") +
                    ", or a poisson_ratio of 0.45.");
    return;
  }
}

// ---- sizes

void lookAtSize(const std::string& whose, const std::vector<Vec3>& x, const dem::Particles& p, Lines& lines) {
  constexpr double often = 300.0, machine = 20.0;  // m
  if (p.size() == 0 || x.empty()) return;
  Extent body, grains;
  body.add(x);
  grains.add(p.x);
  const double diameter = 2.0 * *std::ranges::min_element(p.radius);
  const double all = grains.size() + diameter, size = body.size();
  if (size > machine && size > often * all)
    lines.push_back(whose + " is " + rounded(size) + " m large, and all grains together " + rounded(all) +
                    " m: write \"scale\": 0.001 if its file is in millimetres, or \"100 mm\" for lengths.");
  if (size < diameter)
    lines.push_back(whose + " is " + rounded(size) + " m large, and the smallest grain " + rounded(diameter) +
                    " m: look at \"scale\", which is in metres per unit of a file.");
}

void lookAtSizes(const Built& built, const Scene& scene, Lines& lines) {
  const dem::Particles& p = built.run->grains.particles;
  const auto meshes = std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>();
  for (std::size_t w = 0; w < built.walls.size(); ++w)
    for (std::size_t m = built.walls[w].firstMesh; m < built.walls[w].endMesh; ++m)
      lookAtSize("The surface of walls." + std::to_string(w), meshes[m]->mesh.wall.x, p, lines);
  for (std::size_t s = 0; s < scene.solids.size(); ++s)
    lookAtSize("The solid " + quoted(scene.solids[s].name), built.meshes[s].X, p, lines);
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
    const SolidMaterial& material = scene.solids[s].material;
    const double modulus = std::visit([](const auto& law) { return law.youngsModulus; }, material.law);
    lookAtWaves(quoted(scene.solids[s].name), modulus, material.density, lines);
    lookAtLocking(built, scene.solids[s], s, lines);
  }
  lookAtSizes(built, scene, lines);
  lookAtStep(built, scene, lines);
}

}  // namespace dovetail::scene
