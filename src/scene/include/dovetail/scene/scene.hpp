// Contents of a scene file, as plain structures. All quantities are in SI units. The keys of a file, their help and
// their limits are in keys*.cpp.
#pragma once

#include "dovetail/scene/solids.hpp"

namespace dovetail::scene {

struct Periodic {
  geometry::Box box = requiredBox;  ///< m
  std::array<bool, 3> axes{};
  std::string where;
};
/// Region that grains may not leave.
struct Domain {
  geometry::Box box = requiredBox;  ///< m
  bool removes = false;             ///< a grain that leaves is removed; otherwise it ends the run
  std::string where;
};

struct Relax {
  double kinetic = 1e-8;
  std::int64_t macroSteps = 200000;
};
struct RunFor {
  double time = required;  ///< s
};
/// Equilibria of the solids; grains stand still.
struct Statics {
  std::int64_t loadSteps = 10;
  std::optional<double> time;  ///< s, that passes; not given: none
  bool arcLength = false;      ///< steps of equal arcs, on which the load may fall, in place of equal loads
};
/// Free vibrations of the solids as they are then, without grains.
struct FindModes {
  int count = 6;
};
/// From the start of a stage on; what is not given stays. A motion begins where the wall is.
struct WallChange {
  std::string wall;  ///< name, or number of the item of `walls`
  std::optional<TimeVector> velocity, displacement;
  std::optional<Vec3> angularVelocity;
  std::optional<Turn> turn;
  std::optional<Servo> servo;
  std::optional<Vec3> surfaceVelocity;
  std::optional<bool> present;  ///< whether it is there from then on
  std::string where;
};
struct LoadChange {
  std::string solid;
  Load load;  ///< the set that it is on, its kind and its values
  std::string where;
};
/// In place of all supports of these components on the same node set.
struct SupportChange {
  std::string solid;
  Support support;
  bool present = true;  ///< false: the nodes are let go
  std::string where;
};
/// Of a rigid plane of a solid, which goes on from where it is.
struct PlaneChange {
  std::string solid;
  std::int64_t plane = 0;                  ///< item of its planes
  TimeVector velocity;                     ///< m/s
  std::optional<TimeVector> displacement;  ///< m; in place of a velocity
  std::string where;
};
/// At the start of a stage. Functions of time count from there.
struct Changes {
  std::optional<Vec3> gravity;
  std::optional<ContactLaw> contact;
  std::vector<PairLaw> contacts;
  std::vector<WallChange> walls;
  std::vector<LoadChange> loads;
  std::vector<SupportChange> supports;
  std::vector<PlaneChange> planes;
  std::string where;
};
struct Stage {
  std::variant<Relax, RunFor, Statics, FindModes> kind;
  std::optional<Changes> changes;
  std::string where;
};
struct Steps {
  NumberOrWord dt{0.0, "auto"};  ///< s
  double safety = 0.2;           ///< fraction of the critical step, with "auto": see start
  int stepsPerMacroStep = 1;
  int lag = 0;      ///< coupling::Lag
  int threads = 0;  ///< 0: all processors
  std::string where;
};
/// Position and velocity of the grain that is nearest at the start.
struct GrainProbe {
  Vec3 at = requiredVector;  ///< m
};
/// Displacement of the node, or material point, that is nearest at the start.
struct NodeProbe {
  std::string solid;
  Vec3 at = requiredVector;  ///< m
};
/// Centre of mass of a solid, its velocity, and the least and largest coordinates of its nodes or material points.
struct BodyProbe {
  std::string solid;
};
/// Force of the grains on a wall, their moment about its point, and how far it has come.
struct WallProbe {
  std::string wall;  ///< name, or number of the item of `walls`
};
/// Force of the grains on the surface of a solid, and their moment.
struct SolidProbe {
  std::string solid, on;      ///< face set of its couplings; empty: all
  std::optional<Vec3> point;  ///< m; not given: the origin
};
/// Force of a drive on its grains, and its moment about their centre.
struct DriveProbe {
  int drive = 0;  ///< item of `drives`
};
/// Force of a support on its solid, and its moment about the mean place of the nodes.
struct SupportProbe {
  std::string solid, on;  ///< node set
};
/// Force of a plane on its solid, and how deep that is in it.
struct PlaneProbe {
  std::string solid;
  int plane = 0;  ///< item of `planes`
};
/// Number and mean velocity of the grains in a box.
struct RegionProbe {
  geometry::Box box = requiredBox;  ///< m
  std::string solid;                ///< whose part there at the start is followed; empty: the grains there at any time
};
/// Of the cells of grains of a solid, the mean or one.
struct CellsProbe {
  std::string solid;
  std::optional<Vec3> at;  ///< m
};
struct Probe {
  std::string name;
  std::variant<GrainProbe, NodeProbe, BodyProbe, WallProbe, SolidProbe, DriveProbe, SupportProbe, RegionProbe,
               CellsProbe, PlaneProbe>
      of;
  std::string where;
};
/// A cell of grains of a solid, at the point that is nearest at the start, whose grains are frames of their own.
struct ShownCell {
  std::string name, solid;
  Vec3 at = requiredVector;  ///< m
  std::string where;
};
struct Output {
  std::optional<double> series, frames, checkpoints;                ///< intervals, s; not given: none
  std::vector<std::string> contents{"grains", "solids", "stress"};  ///< of frames
  bool hdf5 = false;                                                ///< the series as HDF5 too
  std::vector<Probe> probes;                                        ///< columns of the series
  std::vector<ShownCell> cells;                                     ///< with frames of their own
  std::string where;
};

/// Of all grains and clumps, see dem::DampingTerm.
struct Damping {
  double rate = 0.0, local = 0.0;  ///< 1/s; 1
  std::string where;
};

struct Scene {
  std::string title, version;
  Parameters parameters;  ///< that functions of time use
  Vec3 gravity;           ///< m/s²
  std::optional<Damping> damping;
  std::optional<ContactLaw> contact;
  std::vector<PairLaw> contacts;
  std::optional<Periodic> periodic;
  std::optional<Domain> domain;
  std::vector<Particles> particles;
  std::vector<Wall> walls;
  std::vector<Clump> clumps;
  std::vector<Insertion> insertions;
  std::vector<Outlet> outlets;
  std::vector<BondGroup> bonds;
  std::vector<Drive> drives;
  std::vector<Cells> cells;
  std::vector<Solid> solids;
  std::vector<Coupling> couplings;
  Steps steps;
  std::vector<Stage> stages;
  Output output;
  std::vector<std::string> files;  ///< that it was read from, and that it names
  std::vector<std::string> unusedParameters;
};

}  // namespace dovetail::scene
