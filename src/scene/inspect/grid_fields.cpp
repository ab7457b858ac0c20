#include "dovetail/scene/grid_fields.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "build/width_advice.hpp"
#include "dovetail/cg/fields.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/snapshot.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/read.hpp"
#include "field_profile.hpp"
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

std::span<const double> flat(const std::vector<Vec3>& vectors) { return {&vectors[0].x, 3 * vectors.size()}; }

std::string textOf(double time, const cg::Grid& grid, const cg::Fields& fields, const io::KeyValues& provenance) {
  std::vector<Eigen::Matrix3d> stress;
  std::vector<double> pressure;
  for (std::size_t p = 0; p < fields.size(); ++p) {
    stress.push_back(fields.stress(p));
    pressure.push_back(-stress.back().trace() / 3.0);
  }
  const std::vector<double> all = rowsOf(stress), contact = rowsOf(fields.contactStress),
                            kinetic = rowsOf(fields.kineticStress);
  const io::GridFrame frame{grid.lower,
                            grid.spacing,
                            grid.count,
                            {{"density", fields.density},
                             {"solid_fraction", fields.solidFraction},
                             {"momentum", flat(fields.momentum), 3},
                             {"velocity", flat(fields.velocity), 3},
                             {"stress", all, 9},
                             {"contact_stress", contact, 9},
                             {"kinetic_stress", kinetic, 9},
                             {"pressure", pressure},
                             {"temperature", fields.temperature},
                             {"wall_force", flat(fields.wallForce), 3}}};
  return io::vtiText(time, frame, provenance);
}

}  // namespace

void writeGridFields(const std::filesystem::path& folder, const GridOptions& settings, std::ostream& log) {
  const char* const ending = settings.profile ? ".csv" : ".vti";
  if (settings.file.extension() != ending)
    throw InputError(settings.profile ? "profiles are CSV files" : "fields on a grid are written as a VTI file",
                     settings.file.string(), std::string("give a name that ends in ") + ending);
  io::requireFreeOrOurs(settings.file);
  const Scene scene = readRun(folder);
  for (const Coupling& coupling : scene.couplings)
    if (std::holds_alternative<PointSpheres>(coupling.kind))
      throw InputError("fields are those of grains, and the spheres of \"" + coupling.solid + "\" are none",
                       folder.string(), "look at the frames of the solid");
  const std::string identity = identityOf(scene);
  Built built = build(scene);
  start(built, scene);
  adopt(lastCheckpoint(folder, log, Damaged::isLeft), identity, built, scene);
  dem::Model& grains = built.run->grains;
  if (grains.particles.size() == 0) throw InputError("there are no grains", folder.string(), "give a run with some");
  dem::findForces(grains);  // of bonds, which states do not hold
  const dem::Snapshot now = dem::takeSnapshot(grains);
  const geometry::Box around = boxAround(grains.particles.x);
  const double diameter = meanDiameter(grains.particles);
  const double width = settings.advisesWidth ? advisedWidth(cg::viewOf(now), around, diameter, settings, log)
                                             : settings.width.value_or(1.5 * diameter);
  const double spacing = settings.spacing.value_or(0.5 * width);
  requirePositive(width, "width");
  requirePositive(spacing, "spacing");
  const cg::Grid grid = gridOver(settings.box.value_or(around), spacing);
  const cg::Fields fields = cg::sample({settings.shape, 3, width}, cg::gridPoints(grid), cg::viewOf(now));
  const io::KeyValues provenance =
      io::provenance({{"scene", hashOf(identity)},
                      {"kernel", settings.shape == cg::KernelShape::lucy ? "lucy" : "gauss"},
                      {"width", formatNumber(width) + " m"}});
  if (settings.profile)
    io::writeCsv(settings.file, profileOf(grid, fields, *settings.profile, width), provenance);
  else
    io::writeFileAtomically(settings.file, textOf(now.time, grid, fields, provenance));
  log << grid.count[0] << " x " << grid.count[1] << " x " << grid.count[2] << " points of " << spacing
      << " m, kernel of " << width << " m, t = " << now.time << " s: " << settings.file.string() << '\n';
}

}  // namespace dovetail::scene
