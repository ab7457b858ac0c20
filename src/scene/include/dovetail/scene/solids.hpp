// Solids of a scene and their couplings to grains.
#pragma once

#include "dovetail/scene/cells.hpp"

namespace dovetail::scene {

struct BoxMesh {
  std::string shape = "hex8";
  std::array<int, 3> cells{};
  geometry::Box box = requiredBox;    ///< m
  std::optional<geometry::Box> hole;  ///< m: cells whose centres lie in it are left out
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
/// What material points fill; in the plane as far as it is thick.
struct PointBox {
  geometry::Box box = requiredBox;  ///< m
};
struct PointBall {
  Vec3 centre = requiredVector;  ///< m
  double radius = required;      ///< m
};
/// Closed.
struct PointSurface {
  TriangleFiles surface;
};
/// Columns x_m, y_m, z_m and, if there, volume_m3 and vx_m_per_s, ….
struct PointFile {
  std::string file;
};
struct PointFilling {
  std::variant<PointBox, CylinderRegion, PointBall, PointSurface, PointFile> from;
  int perAxis = 2;  ///< points along an axis of a cell
};
/// See mpm::GridBorder.
struct PointBorder {
  std::string side = "y-";
  double at = required;  ///< m, along the axis
  int kind = 0;          ///< mpm::BorderKind
  std::string where;
};
/// See mpm::PointOptions.
struct PointGrid {
  double spacing = required;  ///< m
  bool plane = false;
  int shape = 2;  ///< mpm::Shape
  Vec3 origin;    ///< m
  std::vector<PointBorder> borders;
  int transfer = 0;      ///< mpm::Transfer
  double damping = 0.0;  ///< 1/s
  double renewal = 0.25;
};
/// Material points on a grid in place of a mesh.
struct PointMesh {
  PointFilling points;
  PointGrid grid;
};
struct StVenantKirchhoff {
  double youngsModulus = required, poissonRatio = required;
};
struct NeoHookean {
  double youngsModulus = required, poissonRatio = required;
};
/// A point of a yield curve.
struct YieldPoint {
  double plasticStrain = required, yieldStress = required;  ///< accumulated; Pa
};
struct J2Plastic {
  double youngsModulus = required, poissonRatio = required, yieldStress = required, hardening = 0.0;
  std::vector<YieldPoint> hardeningCurve;         ///< in place of `hardening`, behind the initial yield stress
  double kinematicModulus = 0.0, recovery = 0.0;  ///< Pa, 1: of the back stress, see fem::J2Plasticity
};
/// A point of a cohesion curve.
struct CohesionPoint {
  double plasticStrain = required, cohesion = required;  ///< accumulated; Pa
};
struct DruckerPrager {
  double youngsModulus = required, poissonRatio = required, cohesion = required;
  std::vector<CohesionPoint> cohesionCurve;               ///< behind the initial cohesion
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
/// A cell of grains at every quadrature point, see hierarchical::cellField.
struct GrainCells {
  enum class Deal { inTurn, byDepth };
  std::string cells;  ///< name
  Deal deal = Deal::inTurn;
  int tangent = 0;                             ///< hierarchical::Operator
  double inertialNumber = 1e-3;                ///< of load steps
  double strainPerStep = 3e-5, damping = 0.1;  ///< of explicit steps
};
struct SolidMaterial {
  std::variant<StVenantKirchhoff, NeoHookean, J2Plastic, DruckerPrager, AxialSprings, DeformedMetric, GrainCells> law;
  double density = required;  ///< kg/m³; not read of cells, whose grains have it
  double dampingTime = 0.0;   ///< viscosities over elastic moduli, s
};
/// Elements of another material.
struct MaterialRegion {
  std::string elements;  ///< element set
  SolidMaterial material;
  std::string where;
};
struct Support {
  std::string on;  ///< node set
  bool x = true, y = true, z = true;
  TimeVector velocity;                     ///< of the held components, m/s
  std::optional<TimeVector> displacement;  ///< of the held components, m; in place of a velocity; may use the place
  std::optional<Turn> turn;                ///< beside them
  std::optional<Vec3> point;               ///< on its axis, m
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
/// In equal parts on the nodes.
struct NodalLoad {
  TimeVector force{TimeValue{required, ""}};  ///< N, in all
};
struct Load {
  std::string on;  ///< face set; of forces a node set
  std::variant<PressureLoad, TractionLoad, NodalLoad> kind;
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
  double innerRadius = 0.0;      ///< m
};
struct PlaceInCylinder {
  Vec3 point = requiredVector, axis = requiredVector;  ///< m; of any length
  double radius = required;                            ///< m
  double innerRadius = 0.0;                            ///< m
};
/// Faces of the boundary that look in a direction.
struct FacesTowards {
  Vec3 direction = requiredVector;  ///< of any length
  double angle = 0.25;              ///< of their normals to it, rad
};
/// What two sets have in common.
struct CommonPart {
  std::string of, with;
};
struct PlaceAtSide {
  std::string side = "x-";
};
/// Nodes, elements, and faces of the boundary, in a place of the mesh.
struct NamedSet {
  std::string name;
  std::variant<PlaceAtSide, PlaceInBox, PlaceOnPlane, PlaceInSphere, PlaceInCylinder, FacesTowards, CommonPart> place;
  std::string where;
};
/// A rigid plane that faces of the solid cannot pass.
struct SolidPlane {
  std::string on = "skin";                               ///< face set
  Vec3 point = requiredVector, normal = requiredVector;  ///< m; of any length, towards the solid
  TimeVector velocity;                                   ///< m/s
  std::optional<TimeVector> displacement;                ///< m; in place of a velocity
  NumberOrWord stiffness{0.0, "auto"};                   ///< pressure per penetration, Pa/m
  double friction = 0.0;
  std::string where;
};
/// Energy of the gradient of F, see fem::gradientEnergy.
struct SolidGradient {
  double modulus = required;  ///< N
};
/// Displacements, velocities and plastic flow of the solid of that name in another run's checkpoint.
struct StateOfSolid {
  std::string file;
};
struct Solid {
  std::string name;
  std::variant<BoxMesh, MeshFile, TetrahedraMesh, PointMesh> mesh;
  SolidMaterial material;  ///< of all elements but those of the regions
  std::vector<MaterialRegion> regions;
  std::string formulation = "standard";
  std::optional<SolidGradient> gradient;  ///< not given: bands of softening materials are as wide as elements
  bool gravity = true;
  bool implicitSteps = false;
  int linearSolver = 0;                ///< linalg::LinearMethod, of implicit steps
  double massDamping = 0.0;            ///< force over mass and velocity, 1/s
  std::optional<double> massFraction;  ///< of the consistent mass; not given: 1 for implicit steps, else 0
  std::optional<StateOfSolid> state;   ///< initial state; not given: undeformed and at rest
  Vec3 velocity;                       ///< of all nodes at the start, m/s, added to that of the state
  std::vector<NamedSet> sets;
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::vector<MeshTie> ties;
  std::vector<SolidPlane> planes;
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
/// A solid and grains that share the layer between two planes across an axis, or between two boxes.
struct Overlap {
  int axis = 2;
  std::optional<double> solidBorder;                  ///< m: where the solid ends, within the grains
  std::optional<double> particleBorder;               ///< m: where the grains end, within the solid
  std::optional<geometry::Box> solidBox;              ///< m: in place of the planes; the solid ends on its sides
  std::optional<geometry::Box> particleBox;           ///< m: around it; the grains end on its sides
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
/// A sphere at every material point, see mpm::PointContact.
struct PointSpheres {
  std::optional<double> radius;  ///< m; not given: half the distance of points as they fill a cell
  std::string contactMaterial;
};
struct Coupling {
  std::string solid;
  std::variant<SurfaceContact, Overlap, PointSpheres> kind;
  std::string where;
};
}  // namespace dovetail::scene
