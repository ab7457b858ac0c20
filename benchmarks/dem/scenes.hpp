// The scenes that are timed. Lengths in mean diameters, d = 1 m; m = 1 kg for d = 1 m; g = 1 m/s²; k = 2000 N/m.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/model/walls.hpp"

namespace dovetail::dem_benchmark {

/// Centres and diameters, m; velocities, m/s, and spins, rad/s, unless all are at rest.
struct Spheres {
  std::vector<Vec3> x;
  std::vector<double> diameter;
  std::vector<Vec3> v, omega;
  std::size_t size() const { return x.size(); }
};

/// One line per sphere: x y z diameter, and, in all lines or none, velocity and spin.
/// @throws InputError naming file and line
Spheres readSpheres(const std::filesystem::path& path);
void writeSpheres(const std::filesystem::path& path, const Spheres& spheres);
/// The same as an input of LAMMPS (read_data, atom style sphere).
void writeLammpsData(const std::filesystem::path& path, const Spheres& spheres, const geometry::Box& box);

/// A packed bed: 20 × 20 × about 43 spheres on a floor, periodic sideways, settled from a jittered lattice. Takes about
/// a minute for the 20 000 of `layers` = 50.
Spheres settledBed(int width = 20, int layers = 50);
/// A slice, 8 wide, of a drum half full that has turned until its grains flow: 20 000 spheres. Takes half a minute.
Spheres flowingDrum();
/// `copies` side by side along an axis.
Spheres repeated(const Spheres& spheres, int copies, double width, int axis = 0);
/// Cubic lattice of unit spacing in a periodic box.
Spheres lattice(int nx, int ny, int nz, double diameter);
/// Big spheres of ten diameters at random in a cubic lattice of small ones, periodic.
Spheres bigAmongSmall(double edge, int bigOnes, double bigDiameter, unsigned seed);

inline constexpr double stiffness = 2000.0, timeStep = 1e-3, listSkin = 0.1;
inline constexpr double drumRadius = 38.0, drumWidth = 8.0, drumSpeed = 0.05;  ///< m, m, rad/s
inline constexpr double drumStep = 8e-4;  ///< s: below the limit of grains with many damped contacts

/// Laws of the bed: k, k_t = 2/7 k, μ = 0.5, and dashpots as γ_n = 50/s, γ_t = 25/s per effective mass.
dem::FrictionalLaw frictionalLaw();
/// Hertz–Mindlin of about the same stiffness at these overlaps.
dem::HertzMindlinLaw hertzLaw();

/// Puts the spheres into a model with the list made and particles sorted. @param skin m, of the list
dem::Model makeModel(const Spheres& spheres, std::shared_ptr<const dem::ContactLaws> laws,
                     const geometry::Periodicity& periodicity, const Vec3& gravity, double skin = listSkin);
template <class Law>
dem::Model makeModel(const Spheres& spheres, const Law& law, const geometry::Periodicity& periodicity,
                     const Vec3& gravity, double skin = listSkin) {
  return makeModel(spheres, dem::makeContactLaws(law), periodicity, gravity, skin);
}

/// Bed periodic in x and y on a floor at z = 0.
dem::Model bedModel(const Spheres& bed, std::shared_ptr<const dem::ContactLaws> laws, double width,
                    double skin = listSkin);
template <class Law>
dem::Model bedModel(const Spheres& bed, const Law& law, double width, double skin = listSkin) {
  return bedModel(bed, dem::makeContactLaws(law), width, skin);
}

/// Slightly squeezed spheres without friction on a periodic lattice, with a wave running through.
dem::Model waveLattice(int nx, int ny, int nz, double skin = listSkin);

/// Drum of the given length about z, periodic along it, turning; gravity pulls along −y.
dem::Model drumModel(const Spheres& spheres, double length, double skin = listSkin);

/// Five inner faces of an open box, [0, edge]² × [0, height], as planes or meshed with right triangles.
std::vector<dem::PrimitiveWall> boxOfPlanes(double edge, double skin);
dem::MeshWall boxOfTriangles(double edge, double height, int cells, double skin);

}  // namespace dovetail::dem_benchmark
