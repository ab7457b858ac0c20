// From a scene to a run.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/walls/rigid_wall.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/rve/rve.hpp"
#include "dovetail/scene/scene.hpp"

namespace dovetail::scene {

/// What an item of a scene's walls has become: numbers of dem::primitiveWall and dem::meshWall, ends excluded; and how
/// it moves as a whole.
struct WallParts {
  std::size_t firstPrimitive = 0, endPrimitive = 0, firstMesh = 0, endMesh = 0;
  Vec3 point{};                      ///< that it is described from, m
  Vec3 centre{};                     ///< that it turns about and moments are about, from `point`, m
  std::vector<Vec3> arms{}, axes{};  ///< of the primitives as described: their points from `point`
  std::vector<Vec3> offsets{};       ///< of the vertices of the mesh, from `point`
  dem::RigidMotion base{};           ///< where `point` was, and how it was turned, when the motion began
  double since = 0.0;                ///< s, when the motion began
  dem::PrescribedMotion motion{};    ///< of `point`; empty: at rest at `base`, or the servo's
  std::optional<Servo> servo{};
};

/// What stages change of solids, as it is now.
struct ChangingParts {
  std::shared_ptr<Vec3> gravity = std::make_shared<Vec3>();
  std::map<std::string, std::shared_ptr<std::function<double(double)>>> loads{};
  std::map<std::string, std::shared_ptr<std::function<Vec3(double)>>> planes{};  ///< displacements, m
};

/// A support as a stage has left it.
struct SupportNow {
  Support support;
  std::string name;    ///< for messages
  double since = 0.0;  ///< s: its functions of time count from there
  /// Displacements of all nodes then, m, which its motion goes on from; null: those that the solid is built with.
  std::shared_ptr<const std::vector<Vec3>> from{};
};

/// Faces of a solid of material points: places of a set of markers.
struct PointFaces {
  fem::SolidMesh mesh;  ///< without elements
  std::size_t set = 0;
};

/// A run, and data on its parts.
struct Built {
  bool onRanks = false;  ///< whether ranks may share elements
  std::unique_ptr<coupling::CoupledRun> run;
  std::vector<fem::SolidMesh> meshes;                  ///< of the solids, in their order
  std::map<std::string, PointFaces> faces;             ///< by solids of points whose faces something acts on
  std::map<std::string, std::vector<rve::Rve>> cells;  ///< of grains, by their names, as prepared
  std::vector<WallParts> walls;                        ///< of the scene's walls, in their order
  std::vector<std::vector<SupportNow>> supports;       ///< of the solids, in their order
  std::vector<linalg::LinearForecast> forecasts;       ///< of the solids of a started run
  ChangingParts changing;
  std::vector<std::string> notes;  ///< on decisions that the file leaves open, one sentence each
};

/// Fills a closed, welded and oriented surface with elements; sets: "skin".
/// @param size, surfaceDistance  m, as of TetrahedraMesh
using VolumeMesher =
    std::function<fem::SolidMesh(const geometry::TriangleMesh& surface, double size, double surfaceDistance)>;

/// Sets the mesher of solids with "mesh": "tetrahedra" for the whole program; without one, scenes that have them are
/// refused. This component links none, since CGAL's is under the GPL: programs that accept this give
/// fem::tetrahedraInside (component fem_cgal). Not to be called while scenes are built.
void useVolumeMesher(VolumeMesher mesher);

/// Makes all parts; no step is made, and the run has not been started.
/// @param onRanks  under mpirun, solids that multigrid solves are shared by the ranks, which become a team for it
///                 (hierarchical::formTeam): for programs that do nothing but run the scene
/// @throws InputError with the place in the scene file of a part that is impossible, or impossible at its position
Built build(const Scene& scene, bool onRanks = false);

/// Starts the run with the scene's step. "auto": the fraction `safety` of the smallest of the critical step at the
/// start, that of each explicit solid, and the exact one of two of the smallest grains of the scene at an overlap of a
/// twentieth of their radius; and no more than a fifth of the last, so that an impact takes eight steps, unless springs
/// are bonded. A note reports where that is less.
/// @throws InputError as CoupledRun::start, or if nothing in the scene sets a step
void start(Built& built, const Scene& scene);

/// Warnings of likely mistakes, a sentence for each kind, with what to write instead: unusual numbers, deep overlaps at
/// the start, grains in solids, parts that are far apart or duplicated, densities and moduli that do not match in an
/// overlap, unusual widths of overlaps and kernels, faulty meshes and walls, unused names. @param starts  whether the
/// run has started: others have no outputs and no impacts
/// @throws InputError as for outputs that cannot be written
std::vector<std::string> warnings(const Built& built, const Scene& scene, bool starts = true);

/// All limits of the step of the started run in its present state.
std::vector<StepLimit> limits(Built& built, const Scene& scene);

}  // namespace dovetail::scene
