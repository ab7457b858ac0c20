// Solids of a scene and their couplings to grains.
#pragma once

#include "dovetail/scene/grains.hpp"

namespace dovetail::scene {

struct BoxMesh {
  std::string shape = "hex8";
  std::array<int, 3> cells{};
  geometry::Box box = requiredBox;  ///< m
};
struct MeshFile {
  std::string file;
  double scale = 1.0;  ///< m per unit of the file
};
/// Tetrahedra inside a closed surface, see VolumeMesher (build.hpp).
struct TetrahedraMesh {
  std::string file;
  double scale = 1.0;                     ///< m per unit of the file
  double size = required;                 ///< of the tetrahedra, m
  std::optional<double> surfaceDistance;  ///< m; not given: a twentieth of the size
};
struct StVenantKirchhoff {
  double youngsModulus = required, poissonRatio = required;
};
struct NeoHookean {
  double youngsModulus = required, poissonRatio = required;
};
struct J2Plastic {
  double youngsModulus = required, poissonRatio = required, yieldStress = required, hardening = 0.0;
};
struct DruckerPrager {
  double youngsModulus = required, poissonRatio = required, cohesion = required;
  double frictionAngle = required, dilatancyAngle = 0.0;  ///< rad
};
/// As a cubic lattice of springs, see fem::AxialSprings.
struct AxialSprings {
  double youngsModulus = required;
};
/// Hooke's law in the metric of the deformed body, see fem::DeformedMetricHooke.
struct DeformedMetric {
  double youngsModulus = required, poissonRatio = required;
};
struct SolidMaterial {
  std::variant<StVenantKirchhoff, NeoHookean, J2Plastic, DruckerPrager, AxialSprings, DeformedMetric> law;
  double density = required;  ///< kg/m³
};
struct Support {
  std::string on;  ///< node set
  bool x = true, y = true, z = true;
  TimeVector velocity;                     ///< of the held components, m/s
  std::optional<TimeVector> displacement;  ///< of the held components, m; in place of a velocity
  std::string where;
};
/// Normal to the faces.
struct PressureLoad {
  TimeValue pressure{required, ""};  ///< Pa, > 0 where it pushes
  bool follows = true;               ///< acts on the deformed faces
};
/// Per reference area.
struct TractionLoad {
  TimeVector traction{TimeValue{required, ""}};  ///< Pa
};
struct Load {
  std::string on;  ///< face set
  std::variant<PressureLoad, TractionLoad> kind;
  std::string where;
};
/// Nodes tied to adjacent faces, where meshes do not match.
struct MeshTie {
  std::string nodes, faces;     ///< sets
  double tolerance = required;  ///< m
  std::string where;
};

struct PlaceInBox {
  geometry::Box box = requiredBox;  ///< m
};
struct PlaceOnPlane {
  Vec3 point = requiredVector, normal = requiredVector;  ///< m; of any length
  std::optional<double> tolerance;                       ///< m; not given: 1e-6 of the mesh's extent
};
struct PlaceInSphere {
  Vec3 centre = requiredVector;  ///< m
  double radius = required;      ///< m
};
struct PlaceAtSide {
  std::string side = "x-";
};
/// Nodes, and faces of the boundary, in a place of the mesh.
struct NamedSet {
  std::string name;
  std::variant<PlaceAtSide, PlaceInBox, PlaceOnPlane, PlaceInSphere> place;
  std::string where;
};
/// Displacements, velocities and plastic flow of the solid of that name in another run's checkpoint.
struct StateOfSolid {
  std::string file;
};
struct Solid {
  std::string name;
  std::variant<BoxMesh, MeshFile, TetrahedraMesh> mesh;
  SolidMaterial material;
  std::string formulation = "standard";
  bool gravity = true;
  bool implicitSteps = false;
  int linearSolver = 0;                ///< linalg::LinearMethod, of implicit steps
  std::optional<double> massFraction;  ///< of the consistent mass; not given: 1 for implicit steps, else 0
  std::optional<StateOfSolid> state;   ///< initial state; not given: undeformed and at rest
  Vec3 velocity;                       ///< of all nodes at the start, m/s, added to that of the state
  std::vector<NamedSet> sets;
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::vector<MeshTie> ties;
  std::string where;
};

/// Weights by which contacts are spread on a surface.
struct SurfaceKernel {
  NumberOrWord width{0.0, "advised"};  ///< m, or "none" or "advised"
  int shape = 0;                       ///< cg::KernelShape
  int correction = 2;                  ///< cg::KernelCorrection
  friend bool operator==(const SurfaceKernel&, const SurfaceKernel&) = default;
};
struct SurfaceContact {
  std::string on = "skin";  ///< face set
  SurfaceKernel kernel;
  bool spread = false;  ///< surface::SpreadLoad in place of the adjoint transfer
  bool smooth = false;  ///< surface::SmoothSurface in place of facets
  int edges = 0;        ///< dem::EdgeRule
  std::optional<ContactLaw> contact;
  std::string contactMaterial;
};
/// A solid and grains that share the layer between two planes across an axis.
struct Overlap {
  int axis = 2;
  double solidBorder = required;                      ///< m: where the solid ends, within the grains
  double particleBorder = required;                   ///< m: where the grains end, within the solid
  int profile = 0;                                    ///< arlequin::WeightProfile
  double floor = 1e-3;                                ///< arlequin::WeightOptions::floor
  int constraint = 0;                                 ///< arlequin::ConstraintKind
  NumberOrWord penalty{0.0, "auto"};                  ///< Pa/m²
  bool consistentDashpot = false, staggered = false;  ///< arlequin::CouplingOptions::dashpotLags
  int gap = 0;                                        ///< arlequin::GapForm
  bool perElement = false;                            ///< rows of the gap
  double kernel = 0.0;                                ///< width, m
  int kernelShape = 0;                                ///< cg::KernelShape
  bool normalised = true, reachOut = false;           ///< arlequin::ProjectionOptions
  double absorber = 0.0;                              ///< 1/s
  bool initialEquilibrium = false;  ///< the solid begins in equilibrium (arlequin::initialEquilibrium)
};
struct Coupling {
  std::string solid;
  std::variant<SurfaceContact, Overlap> kind;
  std::string where;
};
}  // namespace dovetail::scene
