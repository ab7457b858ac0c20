// Fields of grains at points, for files and for who asks.
#include <algorithm>
#include <cmath>
#include <ostream>

#include "build/width_advice.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/snapshot.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/grid_fields.hpp"
#include "run/checkpoints.hpp"

namespace dovetail::scene {

namespace {

geometry::Box boxAround(const std::vector<Vec3>& places) {
  geometry::Box box{places.at(0), places.at(0)};
  for (const Vec3& x : places)
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = std::min(box.lower[c], x[c]);
      box.upper[c] = std::max(box.upper[c], x[c]);
    }
  return box;
}

double meanDiameter(const dem::Particles& particles) {
  double sum = 0.0;
  for (const double radius : particles.radius) sum += 2.0 * radius;
  return sum / static_cast<double>(particles.size());
}

cg::Grid gridOver(const geometry::Box& box, double spacing) {
  cg::Grid grid{box.lower, {spacing, spacing, spacing}, {1, 1, 1}};
  double points = 1.0;
  for (int c = 0; c < 3; ++c) {
    const double extent = box.upper[c] - box.lower[c], cells = std::floor(extent / spacing + 1e-9);
    if (!(extent >= 0.0)) throw InputError("the box has no extent", "box", "give its lower corner first");
    points *= cells + 1.0;
    if (!(points <= 1e7)) throw InputError("the grid has more than 1e7 points", "spacing", "give a larger one");
    grid.count[static_cast<std::size_t>(c)] = static_cast<int>(cells) + 1;
  }
  return grid;
}

template <class Matrices>
std::vector<double> rowsOf(const Matrices& matrices) {
  std::vector<double> values;
  values.reserve(9 * matrices.size());
  for (const auto& matrix : matrices)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) values.push_back(matrix(i, j));
  return values;
}

std::vector<double> numbersOf(const std::vector<Vec3>& vectors) {
  return {&vectors[0].x, &vectors[0].x + 3 * vectors.size()};
}

void addGrid(SampledFields& sample, const geometry::Box& box, const GridOptions& settings) {
  const double spacing = settings.spacing.value_or(0.5 * sample.kernel.width);
  requirePositive(spacing, "spacing");
  sample.grid = gridOver(box, spacing);
  sample.points = cg::gridPoints(sample.grid);
}

void addPoints(SampledFields& sample, const GridOptions& settings) {
  if (settings.spacing || settings.box)
    throw InputError("there are points as well as a grid", "points", "leave out either points, or spacing and box");
  if (settings.points->empty()) throw InputError("there are no points", "points", "give one or more");
  if (settings.points->size() > 10000000)
    throw InputError("there are more than 1e7 points", "points", "give fewer at once");
  sample.points = *settings.points;
}

}  // namespace

SampledFields sampleFields(const dem::Model& grains, const GridOptions& settings, std::ostream& log) {
  if (grains.particles.size() == 0) throw InputError("there are no grains", "fields", "take them where there are some");
  const dem::Snapshot now = dem::takeSnapshot(grains);
  const geometry::Box around = boxAround(grains.particles.x);
  const double diameter = meanDiameter(grains.particles);
  SampledFields sample{.time = now.time, .kernel = {settings.shape, 3, 0.0}};
  sample.kernel.width = settings.advisesWidth ? advisedWidth(cg::viewOf(now), around, diameter, settings, log)
                                              : settings.width.value_or(1.5 * diameter);
  requirePositive(sample.kernel.width, "width");
  if (settings.points)
    addPoints(sample, settings);
  else
    addGrid(sample, settings.box.value_or(around), settings);
  sample.fields = cg::sample(sample.kernel, sample.points, cg::viewOf(now));
  return sample;
}

void requireGrainsAlone(const Scene& scene, const std::string& where) {
  for (const Coupling& coupling : scene.couplings)
    if (std::holds_alternative<PointSpheres>(coupling.kind))
      throw InputError("fields are those of grains, and the spheres of \"" + coupling.solid + "\" are none", where,
                       "look at the frames of the solid");
}

SampledFields sampleFields(const std::filesystem::path& folder, const GridOptions& settings, std::ostream& log) {
  const Scene scene = readRun(folder);
  requireGrainsAlone(scene, folder.string());
  Built built = build(scene);
  start(built, scene);
  adopt(lastCheckpoint(folder, log, Damaged::isLeft), identityOf(scene), built, scene);
  dem::Model& grains = built.run->grains;
  if (grains.particles.size() == 0) throw InputError("there are no grains", folder.string(), "give a run with some");
  dem::findForces(grains);  // of bonds, which states do not hold
  return sampleFields(grains, settings, log);
}

std::vector<NamedField> namedFields(const cg::Fields& fields) {
  std::vector<Eigen::Matrix3d> stress;
  std::vector<double> pressure;
  for (std::size_t p = 0; p < fields.size(); ++p) {
    stress.push_back(fields.stress(p));
    pressure.push_back(-stress.back().trace() / 3.0);
  }
  return {{"density", fields.density},
          {"solid_fraction", fields.solidFraction},
          {"momentum", numbersOf(fields.momentum), 3},
          {"velocity", numbersOf(fields.velocity), 3},
          {"stress", rowsOf(stress), 9},
          {"contact_stress", rowsOf(fields.contactStress), 9},
          {"kinetic_stress", rowsOf(fields.kineticStress), 9},
          {"pressure", pressure},
          {"temperature", fields.temperature},
          {"wall_force", numbersOf(fields.wallForce), 3}};
}

}  // namespace dovetail::scene
