// A block that hits a wall with its face, beside elements.
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "cases.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/mpm/fill.hpp"
#include "dovetail/mpm/point_contact.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double width = 1.0, pace = 1.0, gap = 0.002, end = 0.08, youngs = 1e6, poisson = 0.3;
constexpr double modulus = youngs * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
const double speed = std::sqrt(modulus / density);

/// Velocity of the centre of mass away from the wall, over that towards it.
double restitutionOf(const fem::Nodes& nodes) { return fem::momentum(nodes).y / (density * width * width * pace); }

/// @param penalty  of the contact, over the confined modulus and the size of an element
double elements(int across, double penalty) {
  const fem::SolidMesh mesh =
      fem::boxOf(fem::ElementShape::quad4, {across, across, 1}, {0.0, gap, 0.0}, {width, width + gap, 1.0});
  fem::Model model = fem::makeModel(mesh);
  model.add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(youngs, poisson, density))));
  fem::ContactOptions options;
  options.penalty = penalty * modulus * across / width;
  model.add(fem::makeContactPlane(mesh, fem::faceSet(mesh, "y-"), {{}, {0.0, 1.0, 0.0}, {}}, options));
  fem::addMass(model);
  for (Vec3& v : model.nodes.v) v.y = -pace;
  const double dt = 0.15 * width / across / speed;
  fem::ExplicitIntegrator(model, dt, {.energyEvery = 0}).run(std::llround(end / dt));
  return restitutionOf(model.nodes);
}

struct Setting {
  coupling::Stepping stepping = coupling::Stepping::explicitSteps;
  mpm::Transfer transfer = mpm::Transfer::flip;
  double fraction = 0.25;  ///< of the time in which a wave passes from point to point, of a (macro) step
  int K = 1;
};

struct Answer {
  double restitution = 0.0, lost = 0.0, residual = 0.0;  ///< by renewals, of the ledger: over the energy at the start
};

/// A sphere at every point meets the wall, with contacts as stiff as the solid.
Answer points(const Setting& set, int across) {
  const double distance = width / across;
  mpm::MaterialPoints points = box({0.0, gap, 0.0}, width, width, distance);
  for (Vec3& v : points.v) v.y = -pace;
  const auto solid =
      mpm::makePoints(points, neoHookeanField(youngs, poisson),
                      {.grid = {.spacing = 2.0 * distance, .origin = {0.0, gap, 0.0}}, .transfer = set.transfer});
  coupling::CoupledRun run;
  coupling::SolidSide& side =
      run.addSolid(std::make_unique<fem::Model>(mpm::makeModel(solid)), {.name = "block", .stepping = set.stepping});
  run.grains.laws = dem::makeContactLaws(dem::ElasticLaw{{modulus}});
  dem::addWall(run.grains, dem::makePlane({}, {0.0, 1.0, 0.0}));
  mpm::addSpheres(run.grains, side, solid, {.radius = 0.5 * distance});
  run.start(set.fraction * distance / speed / set.K, {.stepsPerMacroStep = set.K});
  const double energy = run.kineticEnergy();
  run.advance(std::llround(end / run.macroStep()));
  return {restitutionOf(side.nodes()), run.ledger().joules("block: renewals of points") / energy,
          run.ledger().residual() / energy};
}

/// Markers on its lower face meet a plane as stiff as that of the elements.
Answer markers(mpm::Transfer transfer, int across) {
  const double distance = width / across;
  const mpm::GridOptions grid{.spacing = 2.0 * distance, .origin = {0.0, gap, 0.0}};
  mpm::MaterialPoints points = box({0.0, gap, 0.0}, width, width, distance);
  for (Vec3& v : points.v) v.y = -pace;
  const auto solid = mpm::makePoints(points, neoHookeanField(youngs, poisson), {.grid = grid, .transfer = transfer});
  const fem::SolidMesh faces = mpm::facesOfBox(grid, {{0.0, gap, 0.0}, {width, width + gap, 1.0}}, 2);
  fem::ContactOptions options;
  options.penalty = modulus * across / width;
  auto model = std::make_unique<fem::Model>(mpm::makeModel(solid));
  model->add(
      mpm::onMarkers(solid, solid->addMarkers(faces.X),
                     fem::makeContactPlane(faces, fem::faceSet(faces, "y-"), {{}, {0.0, 1.0, 0.0}, {}}, options)));
  coupling::CoupledRun run;
  coupling::SolidSide& side = run.addSolid(std::move(model), {.name = "block"});
  run.start(0.15 * distance / speed);
  const double energy = run.kineticEnergy();
  run.advance(std::llround(end / run.macroStep()));
  return {restitutionOf(side.nodes()), run.ledger().joules("block: renewals of points") / energy,
          run.ledger().residual() / energy};
}

/// Ways to meet the wall.
struct Row {
  const char* name;
  std::function<Answer(int across)> answer;
};

Row spheres(const char* name, const Setting& set) {
  return {name, [set](int across) { return points(set, across); }};
}

std::vector<Row> allRows() {
  using coupling::Stepping;
  using mpm::Transfer;
  return {{"markers, flip, explicit", [](int n) { return markers(Transfer::flip, n); }},
          {"markers, apic, explicit", [](int n) { return markers(Transfer::apic, n); }},
          spheres("spheres, flip, explicit", {}),
          spheres("spheres, apic, explicit", {.transfer = Transfer::apic}),
          spheres("spheres, flip, implicit", {.stepping = Stepping::implicitSteps, .fraction = 0.5}),
          spheres("spheres, apic, implicit",
                  {.stepping = Stepping::implicitSteps, .transfer = Transfer::apic, .fraction = 0.5}),
          spheres("spheres, apic, implicit, K = 4",
                  {.stepping = Stepping::implicitSteps, .transfer = Transfer::apic, .fraction = 1.0, .K = 4})};
}

}  // namespace

bool rebound(bool quick) {
  bool holds = true;
  const int finest = quick ? 32 : 64;
  double exact = 0.0;
  std::printf(
      "Restitution at points (elements) across\n\n| | 16 | 32 | 64 | off at 32, %% | lost by renewals, %% | "
      "residual, %% |\n|---|---|---|---|---|---|---|\n");
  for (const double penalty : {1.0, 10.0}) {
    std::printf("| quad4, penalty %g M/h |", penalty);
    for (const int across : {16, 32, 64}) std::printf(" %.4f |", exact = elements(across, penalty));
    std::printf(" | | |\n");
  }
  for (const Row& row : allRows()) {
    std::printf("| %s |", row.name);
    Answer judged;
    for (const int across : {16, 32, 64}) {
      if (across > finest) continue;
      const Answer answer = row.answer(across);
      std::printf(" %.4f |", answer.restitution);
      std::fflush(stdout);
      if (across == 32) judged = answer;
    }
    const double off = judged.restitution / exact - 1.0;
    std::printf("%s %+.2f | %.1f | %.3f |\n", quick ? " |" : "", 100.0 * off, 100.0 * judged.lost,
                100.0 * judged.residual);
    holds = holds && std::abs(off) < 0.02;
  }
  return holds;
}

}  // namespace dovetail::benchmark
