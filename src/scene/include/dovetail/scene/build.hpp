// From a scene to a run.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/coupling/run.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/scene/scene.hpp"

namespace dovetail::scene {

/// What an item of a scene's walls has become: numbers of dem::primitiveWall and dem::meshWall, ends excluded.
struct WallParts {
  std::size_t firstPrimitive = 0, endPrimitive = 0, firstMesh = 0, endMesh = 0;
};

/// A run, and what is known of it beside.
struct Built {
  std::unique_ptr<coupling::CoupledRun> run;
  std::vector<fem::SolidMesh> meshes;          ///< of the solids, in their order
  std::vector<WallParts> walls;                ///< of the scene's walls, in their order
  std::vector<fem::LinearForecast> forecasts;  ///< of the solids of a started run
  std::vector<std::string> notes;              ///< of what was done that the file does not say, one sentence each
};

/// Fills a closed, welded and oriented surface with elements; sets: "skin".
/// @param size, surfaceDistance  m, as of TetrahedraMesh
using VolumeMesher =
    std::function<fem::SolidMesh(const geometry::TriangleMesh& surface, double size, double surfaceDistance)>;

/// What makes solids with "mesh": "tetrahedra" from now on, in the whole program; without one, scenes that have them
/// are refused. This component links none, since CGAL's is under the GPL: programs that are content with that give
/// fem::tetrahedraInside (component fem_cgal). Not to be called while scenes are built.
void useVolumeMesher(VolumeMesher mesher);

/// Makes all parts; no step is made, and the run has not been started.
/// @throws InputError with the place in the scene file of the part that cannot be, or not where it lies
Built build(const Scene& scene);

/// A limit of the time step and who sets it.
struct Limit {
  std::string owner;
  double dt;  ///< s, of the grains; infinite where nothing sets it
};

/// Starts the run with the scene's step. "auto": the fraction `safety` of the smallest of the critical step at the
/// start, that of each explicit solid, and the exact one of two of the smallest grains of the scene, pressed together
/// by a twentieth of their radius; and no more than a fifth of the last, which gives an impact eight steps, unless
/// springs are bonded. A note tells where that is less.
/// @throws InputError as CoupledRun::start, or if nothing in the scene tells a step
void start(Built& built, const Scene& scene);

/// What is likely not meant, a sentence for each kind of fault, with what to write instead: numbers far from what is
/// usual, deep overlaps at the start, grains in solids, parts that are far from each other or there twice, densities
/// and moduli that do not go together in an overlap, overlaps and kernels of odd widths, meshes and walls with faults,
/// names that nobody uses. @param starts  whether the run has started: others have no outputs and no impacts
/// @throws InputError as for outputs that cannot be written
std::vector<std::string> warnings(const Built& built, const Scene& scene, bool starts = true);

/// All limits there are, of the started run as it is now.
std::vector<Limit> limits(Built& built, const Scene& scene);

}  // namespace dovetail::scene
