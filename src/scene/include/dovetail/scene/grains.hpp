// Grains of a scene and what acts on them: contacts, walls, bonds, drives, streams.
#pragma once

#include "dovetail/scene/basics.hpp"

namespace dovetail::scene {

/// Resistance to rolling or twisting, see dem::RollingResistance.
struct Rolling {
  double friction = required, stiffnessRatio = required, dampingRatio = 0.0;
};
struct LinearContact {
  double stiffness = required;                ///< N/m
  std::optional<double> tangentialStiffness;  ///< N/m; not given: 2/7 of the normal one
  /// Contacts at the start, or nearly so, are bonded; no others form.
  bool bonded = false;
  bool tension = false;  ///< of the dashpot, see dem::LinearSpringDashpot
};
struct HertzContact {
  double youngsModulus = required;  ///< Pa
  double poissonRatio = required;
};
/// See dem::ElasticPlastic.
struct ElasticPlasticContact {
  double stiffness = required, unloadingStiffness = required;  ///< N/m, k₁ and k₂
  double cohesionStiffness = 0.0, dampingRatio = 0.0;          ///< N/m; 1
  std::optional<double> tangentialStiffness;                   ///< N/m; not given: 2/7 of k₁
};
/// See dem::Cohesion.
struct Adhesion {
  double force = 0.0, stiffness = 0.0, pressure = 0.0, work = 0.0;  ///< N, N/m, Pa, J/m²
};
/// See dem::LiquidBridge.
struct LiquidBridge {
  double surfaceTension = required, volume = required, contactAngle = 0.0;  ///< N/m, m³, rad
};
/// The law of contacts between grains, and of grains with walls and solids.
struct ContactLaw {
  std::variant<LinearContact, HertzContact, ElasticPlasticContact> normal;
  double restitution = 1.0, friction = 0.0, tangentialDampingRatio = 0.0;
  std::optional<Rolling> rolling, twisting;
  std::optional<Adhesion> adhesion;  ///< this or a liquid bridge
  std::optional<LiquidBridge> liquidBridge;
  std::string where;  ///< in the file, of all structures: for messages
};

/// The law between two contact materials, given by their names.
struct PairLaw {
  std::string first, second;
  ContactLaw law;
  std::optional<HertzContact> ofSecond;  ///< with Hertz's law; not given: as the first
};

/// Radii of grains, m; see dem::Sizes.
struct SizeRange {
  double smallest = required, largest = required;
};
struct NormalSizes {
  double mean = required, deviation = required, smallest = required, largest = required;
};
struct LogNormalSizes {
  double median = required, logDeviation = required, smallest = required, largest = required;
};
struct SizeClass {
  double radius = required, number = 1.0;
};
struct SizeClasses {
  std::vector<SizeClass> classes;
};
struct Sieve {
  double opening = required, passing = required;  ///< m; fraction of the mass
};
struct SieveCurve {
  std::vector<Sieve> sieves;
};
struct Sizes {
  std::variant<SizeRange, NormalSizes, LogNormalSizes, SizeClasses, SieveCurve> distribution;
};
/// Data of all sources of spheres.
struct MadeOf {
  double density = required;  ///< kg/m³
};
/// A surface from files.
struct TriangleFiles {
  std::string file;
  std::vector<std::string> more;  ///< files of the same surface
  double tolerance = 0.0;         ///< m: vertices that near to each other become one
  double scale = 1.0;             ///< m per unit of the file
  Vec3 shift;                     ///< m, after scaling
};
struct Lattice : MadeOf {
  enum class Kind { simpleCubic, bodyCentred, faceCentred, hexagonal };
  Kind kind = Kind::hexagonal;
  geometry::Box box = requiredBox;  ///< m
  double radius = required;         ///< m
  std::optional<double> distance;   ///< of centres, m; not given: twice the radius
};
/// A cylinder between two planes.
struct CylinderRegion {
  Vec3 point = requiredVector, axis = requiredVector;  ///< m, centre of one end; towards the other one
  double radius = required, length = required;         ///< m
};
/// A region inside of a box, a cylinder or a closed surface.
struct RandomPacking : MadeOf {
  std::optional<geometry::Box> box;  ///< m; this, or one of the two below
  std::optional<CylinderRegion> cylinder;
  std::optional<TriangleFiles> surface;  ///< closed
  Sizes radius;
  std::optional<double> solidFraction;  ///< not given: 0.55, unless there is a number
  std::int64_t number = 0;              ///< 0: by the solid fraction
  double overlap = 1e-3;
  std::int64_t seed = 1;
};
struct Sphere {
  Vec3 at = requiredVector;  ///< m
  double radius = required;  ///< m
};
struct MovingSphere : Sphere {
  Vec3 velocity, spin;  ///< m/s, rad/s
};
struct SphereList : MadeOf {
  std::vector<MovingSphere> spheres;
};
/// Columns x_m, y_m, z_m, radius_m and, if there, vx_m_per_s, … and wx_rad_per_s, ….
struct SphereFile : MadeOf {
  std::string file;
};
/// Points with the arrays radius and, if there, velocity.
struct SphereFrame : MadeOf {
  std::string file;
};
/// The grains of another run's checkpoint, with the springs of their contacts.
struct GrainsOfState {
  std::string file;
};
/// Spheres of a file of another code, see grain_io.
struct GrainsOfCode {
  std::string file;
  std::optional<double> density;  ///< kg/m³, where the file has none
  std::int64_t type = -1;         ///< those of this type alone; −1: all
};
struct GrainsOfLammps : GrainsOfCode {
  int units = 0;  ///< grain_io::Units
  std::int64_t frame = -1;
};
struct GrainsOfYade : GrainsOfCode {};
struct GrainsOfMercury : GrainsOfCode {
  std::int64_t frame = -1;
};
struct Particles {
  std::variant<Lattice, RandomPacking, SphereList, SphereFile, SphereFrame, GrainsOfState, GrainsOfLammps, GrainsOfYade,
               GrainsOfMercury>
      from;
  std::string name;             ///< of the group, for bonds and drives
  std::string contactMaterial;  ///< empty: that of the law in "contact"
  Vec3 velocity, spin;          ///< m/s, rad/s, added to those of single spheres
  std::string where;
};

struct Plane {
  Vec3 point = requiredVector, normal = requiredVector;  ///< m; towards the grains
};
struct BoxWalls {
  geometry::Box box = requiredBox;  ///< m; grains are inside
  std::vector<std::string> open;    ///< sides without a wall: "x-" … "z+"
};
struct Cylinder {
  Vec3 point = requiredVector, axis = requiredVector;  ///< m
  double radius = required;                            ///< m
  bool inside = true;
};
struct SphereWall {
  Vec3 centre = requiredVector;  ///< m
  double radius = required;      ///< m
  bool inside = true;
};
struct SurfaceFile : TriangleFiles {
  bool closed = false;
  std::optional<Vec3> point;  ///< centre of rotation, m; not given: the centroid of the surface
};
/// What a wall that a load pushes along an axis has beside its load.
struct PushedWall {
  std::optional<double> mass;        ///< kg; not given: that of all grains at the start
  std::optional<double> speedLimit;  ///< m/s
  bool weight = false;               ///< gravity acts on the mass
};
struct KeptForce : PushedWall {
  TimeValue force{required, ""};  ///< N, along the axis
};
struct KeptPressure : PushedWall {
  TimeValue pressure{required, ""};  ///< Pa, along the axis
  double area = required;            ///< m²
};
struct KeptTorque {
  TimeValue torque{required, ""};         ///< N m, about the axis
  std::optional<Vec3> point;              ///< on the axis, m; not given: that of the wall
  std::optional<double> momentOfInertia;  ///< kg m²; not given: that of all grains at the start
  std::optional<double> speedLimit;       ///< rad/s
};
/// See dem::WallServo.
struct Servo {
  std::variant<KeptForce, KeptPressure, KeptTorque> keeps;
  Vec3 axis = requiredVector;
  double damping = 0.7;  ///< dem::WallServo::localDamping
};
/// Along a path and about an axis, of a rigid whole.
struct RigidPath {
  TimeVector velocity;                     ///< m/s
  std::optional<TimeVector> displacement;  ///< m, from where the motion begins; in place of a velocity
  Vec3 angularVelocity;                    ///< rad/s about the centre of the whole
  std::optional<Turn> turn;                ///< about the same, in place of an angular velocity
};
struct WallMotion : RigidPath {
  std::optional<Servo> servo;  ///< in place of a path
};
struct StateOfWall {
  std::string file;
};
struct Wall : WallMotion {
  std::variant<Plane, BoxWalls, Cylinder, SphereWall, SurfaceFile> shape;
  std::string name;
  std::optional<StateOfWall> state;  ///< where it is; not given: as its shape says
  std::string contactMaterial;
  Vec3 surfaceVelocity;  ///< m/s, over the wall, which it does not move
  bool present = true;   ///< at the start
  std::string where;
};

struct Clump {
  std::string name;             ///< of the group, for bonds and drives; several clumps may have one
  std::vector<Sphere> spheres;  ///< in the clump's own coordinates
  std::string contactMaterial;
  double density = required;  ///< kg/m³
  Vec3 at = requiredVector;   ///< of the centre of mass, m
  Vec3 velocity, spin;        ///< m/s, rad/s
  std::string where;
};
/// Spheres of a kind of clump, in its own coordinates.
struct ClumpKind {
  std::vector<Sphere> spheres;
};
/// Of spheres, or of clumps of several kinds.
struct Insertion {
  geometry::Box region = requiredBox;  ///< m
  std::optional<Sizes> radius;         ///< this or `clumps`
  std::vector<ClumpKind> clumps;
  std::string contactMaterial;
  double density = required;                             ///< kg/m³
  Vec3 velocity, spin;                                   ///< m/s, rad/s
  std::optional<double> numberPerSecond, massPerSecond;  ///< one of the three; 1/s, kg/s
  bool replacesLeavers = false;
  double from = 0.0;                ///< s
  std::optional<double> until;      ///< s; not given: to the end
  std::int64_t totalNumber = 0;     ///< 0: no limit
  std::optional<double> totalMass;  ///< kg
  std::int64_t seed = 1;
  std::string where;
};
struct Outlet {
  geometry::Box region = requiredBox;  ///< m
  std::string where;
};

/// Elastic beams between grains that lie close to each other, see dem::BondMaterial.
struct BondGroup {
  std::string group, with;  ///< of particles; `with` not given: within the group
  double gap = 0.0;         ///< m, between surfaces
  double youngsModulus = required, poissonRatio = required;
  double radiusRatio = 1.0;
  std::optional<double> tensileStrength, shearStrength;  ///< Pa; not given: they do not break
  double momentContribution = 1.0, dampingTime = 0.0;    ///< fraction; s
  bool contacts = true;                                  ///< whether bonded grains have contact forces as well
  std::string where;
};
/// Grains and clumps with a prescribed motion; if they spin, with the given spin, each about its own centre, or with
/// that of a turn, all about one axis.
struct Drive : RigidPath {
  std::string group;
  TimeVector spin;  ///< rad/s
  std::string where;
};

}  // namespace dovetail::scene
