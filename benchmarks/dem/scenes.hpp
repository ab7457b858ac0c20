// The scenes that are timed. Lengths in mean diameters, d = 1 m; m = 1 kg for d = 1 m; g = 1 m/s²; k = 2000 N/m.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/dem/laws/common_laws.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem_benchmark {

/// Centres and diameters, m.
struct Spheres {
  std::vector<Vec3> x;
  std::vector<double> diameter;
  std::size_t size() const { return x.size(); }
};

/// One line per sphere: x y z diameter.
/// @throws InputError naming file and line
Spheres readSpheres(const std::filesystem::path& path);
void writeSpheres(const std::filesystem::path& path, const Spheres& spheres);
/// The same as an input of LAMMPS (read_data, atom style sphere).
void writeLammpsData(const std::filesystem::path& path, const Spheres& spheres, const geometry::Box& box);

/// A packed bed: 20 × 20 × about 43 spheres on a floor, periodic sideways, settled from a jittered lattice. Takes about
/// a minute for the 20 000 of `layers` = 50.
Spheres settledBed(int width = 20, int layers = 50);
/// `copies` beds side by side along x.
Spheres repeated(const Spheres& bed, int copies, double width);
/// Cubic lattice of unit spacing in a periodic box.
Spheres lattice(int nx, int ny, int nz, double diameter);
/// Big spheres of ten diameters at random in a cubic lattice of small ones, periodic.
Spheres bigAmongSmall(double edge, int bigOnes, double bigDiameter, unsigned seed);

using FrictionlessModel = dem::Model<dem::ElasticLaw>;
using FrictionalModel = dem::Model<dem::FrictionalLaw>;
using HertzModel = dem::Model<dem::HertzMindlinLaw>;

inline constexpr double stiffness = 2000.0, timeStep = 1e-3, listSkin = 0.1;

/// Laws of the bed: k, k_t = 2/7 k, μ = 0.5, and dashpots as γ_n = 50/s, γ_t = 25/s per effective mass.
dem::FrictionalLaw frictionalLaw();
/// Hertz–Mindlin of about the same stiffness at these overlaps.
dem::HertzMindlinLaw hertzLaw();

/// Puts the spheres into a model with the list made and particles sorted.
template <class Law>
dem::Model<Law> makeModel(const Spheres& spheres, const Law& law, const geometry::Periodicity& periodicity,
                          const Vec3& gravity);

/// Bed periodic in x and y on a floor at z = 0.
template <class Law>
dem::Model<Law> bedModel(const Spheres& bed, const Law& law, double width);

/// Five inner faces of an open box, [0, edge]² × [0, height], as planes or meshed with right triangles.
std::vector<dem::PrimitiveWall> boxOfPlanes(double edge, double skin);
dem::MeshWall boxOfTriangles(double edge, double height, int cells, double skin);

// -- templates

template <class Law>
dem::Model<Law> makeModel(const Spheres& spheres, const Law& law, const geometry::Periodicity& periodicity,
                          const Vec3& gravity) {
  dem::Model<Law> model;
  model.laws = prepare(law);
  model.gravity = gravity;
  model.booking = dem::Booking::off;
  model.sortEvery = 0;
  constexpr double density = 1.9098593171;  // a sphere of diameter 1 m has 1 kg
  for (std::size_t i = 0; i < spheres.size(); ++i)
    addParticle(model.particles, spheres.x[i], {}, 0.5 * spheres.diameter[i], dem::Density{density});
  if (Law::rotates) switchOnRotation(model.particles);
  model.pairs.periodicity = periodicity;
  model.pairs.skin = listSkin;
  findPairs(model.particles, listSkin, model.pairs);
  sortParticles(model.particles, model.pairs);
  return model;
}

template <class Law>
dem::Model<Law> bedModel(const Spheres& bed, const Law& law, double width) {
  geometry::Periodicity sideways{{{0, 0, 0}, {width, 20, 1}}, {true, true, false}};
  auto model = makeModel(bed, law, sideways, {0, 0, -1});
  model.walls.push_back(dem::makePlane({}, {0, 0, 1}));
  model.walls.back().skin = listSkin;
  return model;
}

}  // namespace dovetail::dem_benchmark
