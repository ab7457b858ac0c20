// A block under its weight, on a plane that holds it in several ways, beside elements.
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
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/mpm/fill.hpp"
#include "dovetail/mpm/point_contact.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double height = 1.0, half = 0.5, g = 9.81, youngs = 1e6, poisson = 0.3;  // half of the width
constexpr double modulus = youngs * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));

/// Mean settlement of elements, m: the work of the weight over the weight.
double settledElements(int cells, mpm::BorderKind base) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::quad8, {cells / 2, cells, 1}, {}, {half, height, 1.0});
  fem::Model model = fem::makeModel(mesh);
  model.add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(youngs, poisson, density))));
  fem::Term& weight = model.add(fem::gravity({0.0, -g, 0.0}));
  model.constraints.hold(fem::nodeSet(mesh, "y-"),
                         base == mpm::BorderKind::held ? fem::allComponents : fem::componentY);
  model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
  fem::addMass(model);
  const double before = weight.energy(model.nodes, {});
  fem::solveStatics(model, 1.0, {.firstStep = 1.0});
  return (before - weight.energy(model.nodes, {.t = 1.0})) / (density * half * height * g);
}

struct Block {
  std::vector<Vec3> start;
  std::shared_ptr<mpm::PointSolid> solid;

  double settled(const fem::Nodes& nodes) const {
    double sum = 0.0;
    const std::vector<Vec3> x = solid->places(nodes);
    for (std::size_t p = 0; p < x.size(); ++p) sum += start[p].y - x[p].y;
    return sum / static_cast<double>(x.size());
  }
};

/// @param offset  of the base from a row of nodes, over the spacing of the grid
Block makeBlock(int across, std::vector<mpm::GridBorder> borders, double offset = 0.0) {
  const double distance = height / across;
  const mpm::MaterialPoints points = box({}, half, height, distance);
  borders.push_back({.axis = 0});
  return {points.x, mpm::makePoints(points, neoHookeanField(youngs, poisson),
                                    {.grid = {.spacing = 2.0 * distance,
                                              .origin = {0.0, -2.0 * offset * distance, 0.0},
                                              .borders = std::move(borders)}})};
}

/// In statics, the base being a border of the grid.
double settledOnBorder(int across, mpm::BorderKind base) {
  const Block block = makeBlock(across, {{.axis = 1, .kind = base}});
  fem::Model model = mpm::makeModel(block.solid);
  model.add(mpm::gravity(block.solid, Vec3{0.0, -g, 0.0}));
  fem::addMass(model);
  fem::solveStatics(model, 1.0, {.firstStep = 1.0});
  return block.settled(model.nodes);
}

/// In statics, markers on its face being pressed into a smooth plane.
/// @param stiffness  of the plane, over the confined modulus and the distance of points
double settledOnMarkers(int across, double offset, double stiffness) {
  const Block block = makeBlock(across, {}, offset);
  const double distance = height / across;
  const fem::SolidMesh faces = mpm::facesOfBox({.spacing = 2.0 * distance}, {{}, {half, height, 1.0}}, 2);
  fem::ContactOptions options;
  options.penalty = stiffness * modulus / distance;
  const double start = 1e-2 * density * g * height / options.penalty;  // so that it is held from the beginning
  const auto plane =
      fem::makeContactPlane(faces, fem::faceSet(faces, "y-"), {{0.0, start, 0.0}, {0.0, 1.0, 0.0}, {}}, options);
  fem::Model model = mpm::makeModel(block.solid);
  model.add(mpm::gravity(block.solid, Vec3{0.0, -g, 0.0}));
  model.add(mpm::onMarkers(block.solid, block.solid->addMarkers(faces.X), plane));
  fem::addMass(model);
  fem::solveStatics(model, 1.0, {.firstStep = 1.0});
  return block.settled(model.nodes) + start;
}

/// Damped until it stands, the base being spheres on a smooth wall.
/// @param stiffness  of contacts, over the confined modulus
double settledOnSpheres(int across, double stiffness) {
  const Block block = makeBlock(across, {});
  auto model = std::make_unique<fem::Model>(mpm::makeModel(block.solid));
  model->add(mpm::gravity(block.solid, Vec3{0.0, -g, 0.0}));
  model->add(fem::massDamping(40.0));  // ⅓ of what is critical in the first mode; after 0.6 s settled to 1e-4
  coupling::CoupledRun run;
  coupling::SolidSide& side = run.addSolid(std::move(model));
  run.grains.laws = dem::makeContactLaws(dem::ElasticLaw{{stiffness * modulus}});
  dem::addWall(run.grains, dem::makePlane({}, {0.0, 1.0, 0.0}));
  mpm::addSpheres(run.grains, side, block.solid, {.radius = 0.5 * height / across});
  run.start(0.5 * run.limitAtStart().dt);
  run.advance(std::llround(0.6 / run.dt()));
  return block.settled(side.nodes());
}

/// A way to stand on the plane.
struct Row {
  const char* name;
  std::function<double(int across)> settled;
  mpm::BorderKind base;  ///< of the elements beside it
  double most = 0.0;     ///< off them at 32 points across, if that is judged
};

const std::vector<Row> rows{
    {"border of the grid, slides", [](int n) { return settledOnBorder(n, mpm::BorderKind::symmetry); },
     mpm::BorderKind::symmetry, 1e-3},
    {"border of the grid, held", [](int n) { return settledOnBorder(n, mpm::BorderKind::held); }, mpm::BorderKind::held,
     1e-3},
    {"markers on the face, 10 M/d", [](int n) { return settledOnMarkers(n, 0.0, 10.0); }, mpm::BorderKind::symmetry},
    {"markers, 1000 M/d", [](int n) { return settledOnMarkers(n, 0.0, 1000.0); }, mpm::BorderKind::symmetry, 2e-3},
    {"markers, 1000 M/d, 0.3 h off nodes", [](int n) { return settledOnMarkers(n, 0.3, 1000.0); },
     mpm::BorderKind::symmetry, 1e-2},
    {"markers, 1000 M/d, 0.5 h off nodes", [](int n) { return settledOnMarkers(n, 0.5, 1000.0); },
     mpm::BorderKind::symmetry, 1e-2},
    {"spheres on a wall, k = M", [](int n) { return settledOnSpheres(n, 1.0); }, mpm::BorderKind::symmetry},
    {"spheres on a wall, k = 10 M", [](int n) { return settledOnSpheres(n, 10.0); }, mpm::BorderKind::symmetry},
};

}  // namespace

bool block(bool quick) {
  bool holds = true;
  std::printf(
      "Mean settlement over that of quad8 elements (64 along the height) less 1, in %%, at points along the height\n\n"
      "| base | 8 | 16 | 32 | 64 |\n|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    const double exact = settledElements(64, row.base);
    std::printf("| %s |", row.name);
    for (const int across : {8, 16, 32, 64}) {
      if (across > 32 && quick) continue;
      const double off = row.settled(across) / exact - 1.0;
      std::printf(" %+.3f |", 100.0 * off);
      std::fflush(stdout);
      if (across == 32 && row.most > 0.0) holds = holds && std::abs(off) < row.most;
    }
    std::printf(quick ? " |\n" : "\n");
  }
  return holds;
}

}  // namespace dovetail::benchmark
