// The parts of a scene, put into a run; one source file each.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/scene/build.hpp"

namespace dovetail::fem {
enum class Formulation;
class PointField;
struct SolidOptions;
class PointMaterial;
}  // namespace dovetail::fem
namespace dovetail::mpm {
class PointSolid;
}  // namespace dovetail::mpm

namespace dovetail::scene {

/// Returns act(); what it refuses is told with the place in the file.
template <class Act>
auto atPlace(const std::string& where, Act act) {
  try {
    return act();
  } catch (const InputError& error) {
    throw InputError(error.what(), where, "");
  }
}

/// What things take in a run at least, bytes: measured with `dovetail check` on scenes of a million.
struct BytesPer {
  static constexpr double grain = 500.0, cell = 1000.0, point = 1000.0;
};
/// Before memory is taken. @throws InputError if so many spheres or cells cannot be meant, or do not fit the memory
/// that is free
void requireMemory(double count, const std::string& what, double bytesEach, const std::string& remedy);

std::shared_ptr<const dem::ContactLaws> makeLaws(const ContactLaw& law);
/// Of all pairs of contact materials. @throws InputError telling the place of the law at fault
std::shared_ptr<const dem::ContactLaws> makeLaws(const Scene& scene);
/// Of a contact material in these laws. @throws InputError if no law names it
int contactRow(const Scene& scene, const std::string& name);
/// The briefest impact of a scene.
struct Impact {
  double limit = std::numeric_limits<double>::infinity();  ///< 2/ω, s
  std::string
      materials;  ///< of the two that meet, as " (\"rock\" on \"steel\")"; empty if the scene has one law for all
};
/// The least 2/ω of two equal spheres, of those there are and those that enter, pressed together by a twentieth of the
/// radius under the stiffest law of their material.
Impact briefestImpact(const Scene& scene, const dem::Particles& particles);
/// Of the softest law of a material, N/m, pressed together likewise.
double softestSpring(const Scene& scene, int row, double radius);

/// Particles of groups that have a name, members of clumps among them, by Particles::id.
using Groups = std::map<std::string, std::vector<std::int64_t>>;

Groups addParticles(dem::Model& grains, const Scene& scene, std::vector<std::string>& notes);
void addBondsAndDrives(Built& built, const Scene& scene, const Groups& groups);
/// Of the grains there are and those that enter, m.
double largestRadius(const Scene& scene, const dem::Particles& particles);
void addWalls(Built& built, const Scene& scene);
/// Number of an item of `walls` by its name or number. @throws InputError if there is none
std::size_t wallNamed(const std::string& name, const Scene& scene);
/// Clumps of one name are one group.
void addClumps(dem::Model& grains, const Scene& scene, Groups& groups);
void addStreams(dem::Model& grains, const Scene& scene);
void addSolids(Built& built, const Scene& scene);
void addCouplings(Built& built, const Scene& scene);
/// @throws InputError telling the worst grain, if there are grains on the wrong side of a wall or outside of the
/// domain; where the domain removes those there is a note
void requireTogether(Built& built, const Scene& scene);
/// @throws InputError telling the worst grain, if there are grains on the wrong side of a wall
void requireBefore(const dem::Model& grains, const Scene& scene, std::size_t item, const WallParts& parts);
/// Number of a solid. @throws InputError with the nearest name there is
std::size_t solidNamed(const std::string& name, const coupling::CoupledRun& run);

/// Gives particles from number `first` on their row in the table of laws.
void setContactMaterial(dem::Particles& particles, std::size_t first, int row);

/// @throws InputError if no VolumeMesher is there, or the surface cannot be filled
fem::SolidMesh meshOf(const TetrahedraMesh& from, std::vector<std::string>& notes);

/// Those that are not spheres at material points.
std::size_t countOfGrains(const dem::Particles& particles);

/// Whether a stage takes load steps.
bool hasStatics(const Scene& scene);
/// Puts supports, loads, ties and planes on a solid.
void addBoundaries(fem::Model& model, const fem::SolidMesh& mesh, const Solid& solid, const Scene& scene, Built& built);
/// Faces that loads and planes act on, with the nodes of them that are held throughout, ascending.
struct LoadedFaces {
  const fem::SolidMesh& mesh;
  std::vector<int> clamped;
  std::function<void(std::shared_ptr<fem::Term>)> add;
};
void addLoads(const LoadedFaces& body, const Solid& solid, const Scene& scene, Built& built);
/// Of the planes of a solid, in their order, in its present state.
std::vector<fem::ContactPlane::Report> planeReports(const fem::Model& model);
void addPlanes(const LoadedFaces& body, const Solid& solid, const Scene& scene, Built& built);
/// Adds the sets of the scene to those of the mesh. @throws InputError for names that are there, and empty sets
void addSets(fem::SolidMesh& mesh, const Solid& solid);

/// Its mesh, or the faces of a body of points on which something acts.
const fem::SolidMesh& facesOf(const Built& built, const Scene& scene, std::size_t solid);
bool isOfPoints(const Solid& solid);
/// Their model, with gravity. In the place of their mesh is one without elements, whose nodes are the points as they
/// start. @throws InputError for what has no meaning without elements, and points beyond a border
std::unique_ptr<fem::Model> makePoints(const Solid& solid, const Scene& scene, Built& built);
/// Null for solids with a mesh.
const mpm::PointSolid* materialPoints(const fem::Model& model);

/// Null for cells of grains, which are a field (fieldOf).
std::shared_ptr<const fem::PointMaterial> makeMaterial(const SolidMaterial& material);
/// Pa; none of cells of grains.
std::optional<double> youngsModulusOf(const SolidMaterial& material);
/// 0 of laws without.
double poissonRatioOf(const SolidMaterial& material);
/// Pa, at rest; of cells of grains an upper bound.
double confinedModulusOf(const SolidMaterial& material, const Built& built);
inline bool hasCells(const SolidMaterial& material) { return std::holds_alternative<GrainCells>(material.law); }
/// Makes the cells of the scene. @throws InputError for two of one name, files that are none, and cells that do not
/// come to the pressure
void addCells(Built& built, const Scene& scene);
std::vector<rve::Rve> makeCells(const Cells& cells);
inline constexpr double restOfCells = 1e-6;  ///< forces out of balance over the mean contact force
/// Where cells go.
struct CellPlaces {
  std::vector<Vec3> corners;                  ///< of the solid: depths are below the highest, m
  std::function<std::vector<Vec3>()> points;  ///< that get a cell, m
  Vec3 gravity;                               ///< on the solid, m/s²
  bool loadSteps = false;                     ///< whether they rest at every state, in place of following a motion
};
/// A field of its own for each term. @throws InputError if cells are dealt by depth and nothing weighs
std::shared_ptr<fem::PointField> fieldOf(const GrainCells& law, const Built& built, const CellPlaces& places);
/// Whether points rest at every state, in place of following a motion.
bool takesLoadStepsAlone(const Scene& scene);
/// @throws InputError for stages and steps that cells cannot answer for
void requireCellStages(const Solid& solid, const Scene& scene);
/// @throws InputError for discs out of plane strain, or in elements that do not keep it
void requireDimension(const GrainCells& law, int dimension, fem::Formulation formulation, const Built& built);
double confinedModulus(const GrainCells& law, const Built& built);
/// Of a started run. @throws InputError if neither supports nor loads hold the stress that cells start with; of
/// material points, which may flow, it is a note
void requireHeldCells(Built& built, const Scene& scene);
/// The first is that of all elements without a region, the others those of the regions.
std::vector<const SolidMaterial*> materialsOf(const Solid& solid);
/// Whether it remembers plastic strains.
inline bool yields(const SolidMaterial& material) {
  return std::holds_alternative<J2Plastic>(material.law) || std::holds_alternative<DruckerPrager>(material.law);
}
/// Of the elements of a term of this name.
const SolidMaterial& materialOf(const Solid& solid, const std::string& term);
/// Which of them each element has. @throws InputError for a set that does not exist, or an element in two regions
std::vector<std::size_t> materialByElement(const Solid& solid, const fem::SolidMesh& mesh);
/// @throws InputError unless there are two borders, of one kind, apart from each other
void requireBorders(const Overlap& overlap);
/// 0 on the border of the solid and 1 on that of the grains, linear between; less than 0 where grains are alone, more
/// than 1 where the solid is. @throws InputError as arlequin::boxCoordinate
std::vector<double> overlapPlaces(const Overlap& overlap, std::span<const Vec3> points);
/// w of the grains per node of the mesh. @throws InputError for borders between which no node lies
std::vector<double> overlapWeights(const Overlap& overlap, const fem::SolidMesh& mesh);

struct MeshOfFile {
  fem::SolidMesh mesh;
  std::vector<std::string> notes;  ///< of what its reader dropped or passed over
};

struct SurfaceOfFile {
  geometry::TriangleMesh mesh;
  std::vector<std::string> notes;  ///< of what its reader passed over
};
/// The surface of some files together, repaired; notes tell of what was dropped or turned.
/// @param tolerance  of vertices that become one, in the unit of the files
geometry::TriangleMesh repairedSurface(const std::vector<std::string>& files, double tolerance,
                                       geometry::ClosedPatches closed, std::vector<std::string>& notes);
/// The same of the files of a structure, scaled and shifted.
geometry::TriangleMesh surfaceOf(const TriangleFiles& from, geometry::ClosedPatches closed,
                                 std::vector<std::string>& notes);

// Files of kinds that depend on the build.
SurfaceOfFile readTriangles(const std::string& file);
MeshOfFile readMesh(const std::string& file);
std::vector<MovingSphere> readSpheres(const std::string& file);

}  // namespace dovetail::scene
