// What a scene file says, as plain structures. All quantities are in SI units; `required` marks numbers that a file
// must give. The keys of a file, their help and their limits are in keys.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::scene {

inline constexpr double required = std::numeric_limits<double>::quiet_NaN();
inline constexpr Vec3 requiredVector{required, required, required};
inline constexpr geometry::Box requiredBox{requiredVector, requiredVector};

/// Resistance to rolling or twisting, see dem::RollingResistance.
struct Rolling {
  double friction = required, stiffnessRatio = required, dampingRatio = 0.0;
};
struct LinearContact {
  double stiffness = required;                ///< N/m
  std::optional<double> tangentialStiffness;  ///< N/m; not given: 2/7 of the normal one
};
struct HertzContact {
  double youngsModulus = required;  ///< Pa
  double poissonRatio = required;
};
/// The law of contacts between grains, and of grains with walls and solids.
struct ContactLaw {
  std::variant<LinearContact, HertzContact> normal;
  double restitution = 1.0, friction = 0.0, tangentialDampingRatio = 0.0;
  std::optional<Rolling> rolling, twisting;
  std::string where;  ///< in the file, of all structures: for messages
};

struct Periodic {
  geometry::Box box = requiredBox;  ///< m
  std::array<bool, 3> axes{};
};
/// Where grains may be.
struct Domain {
  geometry::Box box = requiredBox;  ///< m
  bool removes = false;             ///< who leaves it leaves the scene; otherwise it ends the run
};

struct SizeRange {
  double smallest = required, largest = required;  ///< radii, m
};
struct Lattice {
  enum class Kind { simpleCubic, bodyCentred, faceCentred, hexagonal };
  Kind kind = Kind::hexagonal;
  geometry::Box box = requiredBox;  ///< m
  double radius = required;         ///< m
  std::optional<double> distance;   ///< of centres, m; not given: twice the radius
};
struct RandomPacking {
  geometry::Box box = requiredBox;  ///< m
  SizeRange radius;
  double solidFraction = 0.55, overlap = 1e-3;
  std::int64_t seed = 1;
};
struct Sphere {
  Vec3 at = requiredVector;  ///< m
  double radius = required;  ///< m
  Vec3 velocity;             ///< m/s
};
struct SphereList {
  std::vector<Sphere> spheres;
};
/// Columns x_m, y_m, z_m, radius_m and, if there, vx_m_per_s, vy_m_per_s, vz_m_per_s.
struct SphereFile {
  std::string file;
};
struct Particles {
  std::variant<Lattice, RandomPacking, SphereList, SphereFile> from;
  double density = required;  ///< kg/m³
  Vec3 velocity;              ///< m/s, beside those of single spheres
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
struct SurfaceFile {
  std::string file;
  double scale = 1.0;  ///< m per unit of the file
  Vec3 shift;          ///< m, after scaling
  bool closed = false;
};
struct Wall {
  std::variant<Plane, BoxWalls, Cylinder, SphereWall, SurfaceFile> shape;
  Vec3 velocity, angularVelocity;  ///< m/s; rad/s about `point`, `centre`, or the mean of the vertices
  std::string where;
};

struct Clump {
  std::vector<Sphere> spheres;  ///< in a frame of its own
  double density = required;    ///< kg/m³
  Vec3 at = requiredVector;     ///< of the centre of mass, m
  Vec3 velocity, spin;          ///< m/s, rad/s
  std::string where;
};
struct Insertion {
  geometry::Box region = requiredBox;  ///< m
  SizeRange radius;
  double density = required;                             ///< kg/m³
  Vec3 velocity;                                         ///< m/s
  std::optional<double> numberPerSecond, massPerSecond;  ///< one of the two; 1/s, kg/s
  std::int64_t seed = 1;
  std::string where;
};
struct Outlet {
  geometry::Box region = requiredBox;  ///< m
  std::string where;
};

struct BoxMesh {
  std::string shape = "hex8";
  std::array<int, 3> cells{};
  geometry::Box box = requiredBox;  ///< m
};
struct MeshFile {
  std::string file;
  double scale = 1.0;  ///< m per unit of the file
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
struct SolidMaterial {
  std::variant<StVenantKirchhoff, NeoHookean, J2Plastic, DruckerPrager> law;
  double density = required;  ///< kg/m³
};
struct Support {
  std::string on;  ///< node set
  bool x = true, y = true, z = true;
  Vec3 velocity;  ///< of the held components, m/s
  std::string where;
};
struct Solid {
  std::string name;
  std::variant<BoxMesh, MeshFile> mesh;
  SolidMaterial material;
  std::string formulation = "standard";
  bool gravity = true;
  bool implicitSteps = false;
  Vec3 velocity;  ///< of all nodes at the start, m/s
  std::vector<Support> supports;
  std::string where;
};

/// A number, or one of the words that a key knows.
struct NumberOrWord {
  double number = 0.0;
  std::string word;  ///< empty: the number counts
};
struct SurfaceContact {
  std::string on = "skin";           ///< face set
  NumberOrWord kernel{0.0, "none"};  ///< width, m, or "none" or "advised"
  std::optional<ContactLaw> contact;
};
/// A solid and grains that share the layer between two planes across an axis.
struct Overlap {
  int axis = 2;
  double solidBorder = required;      ///< m: where the solid ends, within the grains
  double particleBorder = required;   ///< m: where the grains end, within the solid
  int profile = 0;                    ///< arlequin::WeightProfile
  bool multipliers = false;           ///< in place of a penalty
  NumberOrWord penalty{0.0, "auto"};  ///< Pa/m²
  double kernel = 0.0;                ///< width, m
};
struct Coupling {
  std::string solid;
  std::variant<SurfaceContact, Overlap> kind;
  std::string where;
};

struct Settle {
  double kinetic = 1e-8;
  std::int64_t windows = 200000;
};
struct RunFor {
  double time = required;  ///< s
};
struct Stage {
  std::variant<Settle, RunFor> kind;
  std::string where;
};
struct Steps {
  NumberOrWord dt{0.0, "auto"};  ///< s
  double safety = 0.2;           ///< share of the critical step, with "auto"
  int stepsPerWindow = 1;
  int threads = 0;  ///< 0: all processors
  std::string where;
};
/// Position and velocity of the grain that is nearest at the start.
struct GrainProbe {
  Vec3 at = requiredVector;  ///< m
};
/// Displacement of the node that is nearest at the start.
struct NodeProbe {
  std::string solid;
  Vec3 at = requiredVector;  ///< m
};
/// Force of the grains on a wall.
struct WallProbe {
  int wall = 0;  ///< item of `walls`
};
/// Force of a support on its solid.
struct SupportProbe {
  std::string solid, on;  ///< node set
};
/// Number and mean velocity of the grains in a box.
struct RegionProbe {
  geometry::Box box = requiredBox;  ///< m
};
struct Probe {
  std::string name;
  std::variant<GrainProbe, NodeProbe, WallProbe, SupportProbe, RegionProbe> of;
  std::string where;
};
struct Output {
  std::optional<double> series, frames, checkpoints;                ///< intervals, s; not given: none
  std::vector<std::string> contents{"grains", "solids", "stress"};  ///< of frames
  bool hdf5 = false;                                                ///< the series as HDF5 too
  std::vector<Probe> probes;                                        ///< columns of the series
  std::string where;
};

struct Scene {
  std::string title;
  Vec3 gravity;  ///< m/s²
  std::optional<ContactLaw> contact;
  std::optional<Periodic> periodic;
  std::optional<Domain> domain;
  std::vector<Particles> particles;
  std::vector<Wall> walls;
  std::vector<Clump> clumps;
  std::vector<Insertion> insertions;
  std::vector<Outlet> outlets;
  std::vector<Solid> solids;
  std::vector<Coupling> couplings;
  Steps steps;
  std::vector<Stage> stages;
  Output output;
};

}  // namespace dovetail::scene
