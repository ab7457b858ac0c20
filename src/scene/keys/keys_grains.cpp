// Keys of grains and of what acts on them; keys_contacts.cpp and keys_sizes.cpp have those of contacts and sizes.
#include "keys.hpp"

namespace dovetail::scene {

// ---- grains

void describe(Fields& f, Lattice& v) {
  static constexpr const char* kinds[] = {"simple-cubic", "body-centred", "face-centred", "hexagonal"};
  f.choice({"lattice", "type of the lattice"}, v.kind, kinds);
  f.box({"box", "filled with whole spheres from the lower corner; where it spans a period, the lattice is periodic"},
        v.box);
  f.number({"radius", "of all spheres"}, v.radius, positive(unit::length));
  f.number({"distance", "between nearest centres; twice the radius if not given"}, v.distance, positive(unit::length));
  density(f, v.density);
}
void describe(Fields& f, CylinderRegion& v) {
  f.vector({"point", "centre of one end"}, v.point, unit::length);
  f.vector({"axis", "direction towards the other end, of any length"}, v.axis, unit::none);
  f.number({"radius", "of the cylinder"}, v.radius, positive(unit::length));
  f.number({"length", "between the ends"}, v.length, positive(unit::length));
}
void describe(Fields& f, RandomPacking& v) {
  f.box({"box", "that is filled; where it spans a period, the packing is periodic; or cylinder or surface"}, v.box);
  f.object({"cylinder", "that is filled, in place of a box"}, v.cylinder);
  f.object({"surface", "closed, whose inside is filled, in place of a box"}, v.surface);
  f.object({"radius", "of the spheres"}, v.radius);
  f.number({"solid_fraction", "volume of the spheres over that of the region; 0.55 if there is no number"},
           v.solidFraction, between(0.0, 0.74, true, true));
  f.integer({"number", "of spheres, exactly, in place of a solid fraction; 0: not given"}, v.number, 0, many);
  f.number({"overlap", "largest overlap in the packing, over the smaller radius"}, v.overlap, between(0.0, 0.1, true));
  f.integer({"seed", "the same seed gives the same packing"}, v.seed, 0, anySeed);
  density(f, v.density);
}
void describe(Fields& f, Sphere& v) {
  f.vector({"at", "centre"}, v.at, unit::length);
  f.number({"radius", "of the sphere"}, v.radius, positive(unit::length));
}
void describe(Fields& f, MovingSphere& v) {
  describe(f, static_cast<Sphere&>(v));
  velocity(f, v.velocity, "at the start");
  f.vector({"spin", "angular velocity at the start"}, v.spin, unit::spin);
}
void describe(Fields& f, SphereList& v) {
  f.list({"spheres", "centre and radius of each"}, v.spheres, true);
  density(f, v.density);
}
void describe(Fields& f, SphereFile& v) {
  f.file({"file",
          "CSV with columns x_m, y_m, z_m, radius_m and, all or none, vx_m_per_s, vy_m_per_s, vz_m_per_s, and likewise "
          "wx_rad_per_s, wy_rad_per_s, wz_rad_per_s"},
         v.file);
  density(f, v.density);
}
void describe(Fields& f, SphereFrame& v) {
  f.file({"file", "VTP or VTU with point arrays radius and, if there, velocity, such as a frame of another run"},
         v.file);
  density(f, v.density);
}
void describe(Fields& f, GrainsOfState& v) {
  f.file({"file",
          "checkpoint of another run with the same contact laws: its grains with masses, spins and contact springs, "
          "also those to the same walls and to solids with a state of the same file, so that a system at rest stays at "
          "rest; clumps and bonds are not read"},
         v.file);
}
namespace {
void ofCode(Fields& f, GrainsOfCode& v, const char* types) {
  f.number({"density", "mass per volume, where the file has none"}, v.density, positive(unit::density));
  f.integer({"type", types}, v.type, -1, many);
}
void frame(Fields& f, std::int64_t& value) {
  f.integer({"frame", "of a file with several, from 0; -1 is the last, -2 the one before"}, value, -many, many);
}
}  // namespace

void describe(Fields& f, GrainsOfLammps& v) {
  static constexpr const char* systems[] = {"file", "si", "cgs", "micro", "nano", "lj"};
  f.file(
      {"file",
       "data file of LAMMPS or LIGGGHTS (atom style sphere, granular, bpm/sphere or hybrid of sphere), or a text dump "
       "with positions, radii and, if there, velocities, omegas, densities or masses"},
      v.file);
  f.choice({"units", "of the file; file: those it names, else si; lj: taken as metres, kilograms and seconds"}, v.units,
           systems);
  frame(f, v.frame);
  ofCode(f, v, "of atoms: only these; -1: all");
}
void describe(Fields& f, GrainsOfYade& v) {
  f.file({"file", "text of export.text or export.textExt of YADE: x_y_z_r, with matId, id or attrs"}, v.file);
  ofCode(f, v, "number of a material: only its spheres; -1: all");
}
void describe(Fields& f, GrainsOfMercury& v) {
  f.file({"file", "restart or .data file of MercuryDPM; its walls and boundaries are not read"}, v.file);
  frame(f, v.frame);
  ofCode(f, v, "number of a species: only its spheres; -1: all");
}
void describe(Fields& f, Particles& v) {
  static constexpr const char* sources[] = {"lattice", "packing", "list", "csv",    "vtk",
                                            "state",   "lammps",  "yade", "mercury"};
  f.where(v.where);
  f.oneOf({"from", "where the spheres come from"}, v.from, sources);
  f.text({"name", "of the group, for bonds and drives"}, v.name, false);
  contactMaterial(f, v.contactMaterial);
  velocity(f, v.velocity, "of all grains at the start");
  f.vector({"spin", "angular velocity of all grains at the start"}, v.spin, unit::spin);
}

// ---- walls

void describe(Fields& f, Plane& v) {
  f.vector({"point", "on the plane"}, v.point, unit::length);
  f.vector({"normal", "towards the grains, of any length"}, v.normal, unit::none);
}
void describe(Fields& f, BoxWalls& v) {
  f.box({"box", "with the grains inside"}, v.box);
  f.wordList({"open", "sides without a wall"}, v.open, sides, false);
}
void describe(Fields& f, Cylinder& v) {
  f.vector({"point", "on the axis"}, v.point, unit::length);
  f.vector({"axis", "direction, of any length"}, v.axis, unit::none);
  f.number({"radius", "of the cylinder, which is infinitely long"}, v.radius, positive(unit::length));
  f.flag({"inside", "whether grains are inside"}, v.inside);
}
void describe(Fields& f, SphereWall& v) {
  f.vector({"centre", "of the sphere"}, v.centre, unit::length);
  f.number({"radius", "of the sphere"}, v.radius, positive(unit::length));
  f.flag({"inside", "whether grains are inside"}, v.inside);
}
void describe(Fields& f, TriangleFiles& v) {
  f.file({"file", "triangles: STL, OBJ, PLY, or VTP where the build has VTK"}, v.file);
  f.fileList({"more_files", "further files of the same surface"}, v.more);
  f.number({"tolerance", "vertices no farther apart become one, so that edges of gaps and files close"}, v.tolerance,
           notNegative(unit::length));
  f.number({"scale", "metres per unit of the file"}, v.scale, positive(unit::none));
  f.vector({"shift", "after scaling"}, v.shift, unit::length);
}
void describe(Fields& f, SurfaceFile& v) {
  describe(f, static_cast<TriangleFiles&>(v));
  f.flag({"closed",
          "closed surface with contact on the side of its normals only: a body, or with normals inwards a cavity "
          "around the grains; otherwise a sheet with contact on both sides"},
         v.closed);
  f.vector({"point", "centre of rotation; the centroid of the surface if not given"}, v.point, unit::length);
}
void describe(Fields& f, Turn& v) {
  f.vector({"axis", "of any length"}, v.axis, unit::none);
  f.vector({"point", "on the axis; if not given the point or centre of the wall, or the centre of the group"}, v.point,
           unit::length);
  f.function({"angle", "may be an expression of the time t; counter-clockwise seen from the tip of the axis"}, v.angle,
             any(unit::angle));
}
namespace {
void pushed(Fields& f, PushedWall& v) {
  f.number({"mass", "of the wall: larger is slower and smoother; that of all particles at the start if not given"},
           v.mass, positive(unit::mass));
  f.number({"speed_limit", "largest speed, as where no grain touches the wall; none if not given"}, v.speedLimit,
           positive(unit::velocity));
  f.flag({"weight", "whether gravity acts on the mass, as on that of a lid"}, v.weight);
}
constexpr Key turnKey{"turn", "rotation, in place of an angular velocity"};
constexpr Key servoKey{"servo", "moves the wall so that it keeps a force, a pressure or a torque; in place of a path"};
constexpr Key beltKey{"surface_velocity",
                      "of the surface over the wall, as of a belt: along a plane or flat mesh, or a cylinder's axis"};
void rigidPath(Fields& f, RigidPath& v) {
  path(f, v.velocity, v.displacement);
  f.vector({"angular_velocity", "constant, about an axis through the point or centre"}, v.angularVelocity, unit::spin);
  f.object(turnKey, v.turn);
}
}  // namespace

void describe(Fields& f, KeptForce& v) {
  f.function({"force", "on the wall, along the axis: may be an expression of the time t"}, v.force, any(unit::force));
  pushed(f, v);
}
void describe(Fields& f, KeptPressure& v) {
  f.function({"pressure", "force on the wall along the axis over the area: may be an expression of the time t"},
             v.pressure, any(unit::pressure));
  f.number({"area", "over which the pressure acts"}, v.area, positive(unit::area));
  pushed(f, v);
}
void describe(Fields& f, KeptTorque& v) {
  f.function({"torque", "on the wall, about the axis: may be an expression of the time t"}, v.torque,
             any(unit::torque));
  f.vector({"point", "on the axis; the point or centre of the wall if not given"}, v.point, unit::length);
  f.number({"moment_of_inertia", "about the axis; that of all particles at the start if not given"}, v.momentOfInertia,
           positive(unit::inertia));
  f.number({"speed_limit", "largest angular velocity; none if not given"}, v.speedLimit, positive(unit::spin));
}
void describe(Fields& f, Servo& v) {
  static constexpr const char* kinds[] = {"force", "pressure", "torque"};
  f.oneOf({"keeps", "what contacts balance at rest"}, v.keeps, kinds);
  f.vector({"axis", "along which, or about which, the load pushes the wall; of any length"}, v.axis, unit::none);
  f.number({"damping", "fraction of the unbalanced force that acts against the motion; 0: the wall moves freely"},
           v.damping, {unit::none, 0.0, 1.0, false, true});
}
void describe(Fields& f, StateOfWall& v) {
  f.file(
      {"file",
       "checkpoint with a wall of this name and shape: the wall starts where it is there, as a lid on a bed that has "
       "settled; not of a mesh"},
      v.file);
}
void describe(Fields& f, Wall& v) {
  static constexpr const char* shapes[] = {"plane", "box", "cylinder", "sphere", "mesh"};
  f.where(v.where);
  f.oneOf({"shape", "of the wall"}, v.shape, shapes);
  f.text({"name", "for probes and changes: letters, digits, '_', '-' and '.', with a letter first"}, v.name, false);
  contactMaterial(f, v.contactMaterial);
  f.object({"state", "place of the wall, of another run"}, v.state);
  rigidPath(f, v);
  f.object(servoKey, v.servo);
  f.vector(beltKey, v.surfaceVelocity, unit::velocity);
  f.flag({"present", "at the start; a stage may take the wall away or put it in place"}, v.present);
}
void describe(Fields& f, WallChange& v) {
  f.where(v.where);
  f.nameOrNumber({"wall", "its name, or which item of \"walls\", counted from 0"}, v.wall);
  f.functions({"velocity", "ends the motion before; may be expressions of t"}, v.velocity, unit::velocity);
  f.functions({"displacement", "ends the motion before; from where the wall is then; expressions of t"}, v.displacement,
              unit::length);
  f.vector({"angular_velocity", "ends the motion before; constant"}, v.angularVelocity, unit::spin);
  f.object(turnKey, v.turn);
  f.object(servoKey, v.servo);
  f.vector(beltKey, v.surfaceVelocity, unit::velocity);
  f.flag({"present", "false takes the wall away, true puts it in place; as before if not given"}, v.present);
}

// ---- clumps, insertions, outlets

void describe(Fields& f, Clump& v) {
  f.where(v.where);
  f.text({"name", "of the group, for bonds and drives; clumps of one name are one group"}, v.name, false);
  f.list({"spheres", "of the clump, in its own coordinates"}, v.spheres, true);
  contactMaterial(f, v.contactMaterial);
  density(f, v.density);
  f.vector({"at", "centre of mass"}, v.at, unit::length);
  velocity(f, v.velocity, "at the start");
  f.vector({"spin", "at the start"}, v.spin, unit::spin);
}
void describe(Fields& f, ClumpKind& v) { f.list({"spheres", "of the clump, in its own coordinates"}, v.spheres, true); }
void describe(Fields& f, Insertion& v) {
  f.where(v.where);
  f.box({"region", "in which whole grains are inserted where they touch nothing"}, v.region);
  f.object({"radius", "of spheres; this or clumps"}, v.radius);
  f.list({"clumps", "kinds of clumps, each as often, turned at random; this or radius"}, v.clumps);
  contactMaterial(f, v.contactMaterial);
  density(f, v.density);
  velocity(f, v.velocity, "of inserted grains");
  f.vector({"spin", "angular velocity of inserted grains"}, v.spin, unit::spin);
  f.number({"number_per_second", "rate; this, mass_per_second or replaces_leavers"}, v.numberPerSecond,
           positive(unit::rate));
  f.number({"mass_per_second", "rate; this, number_per_second or replaces_leavers"}, v.massPerSecond,
           positive(unit::massRate));
  f.flag({"replaces_leavers", "one enters for each grain that leaves the scene, in place of a rate"},
         v.replacesLeavers);
  f.number({"from", "time at which it begins, since the start of the run"}, v.from, notNegative(unit::time));
  f.number({"until", "time at which it ends; if not given, it goes on"}, v.until, positive(unit::time));
  f.integer({"total_number", "it ends when so many grains have entered; 0: no limit"}, v.totalNumber, 0, many);
  f.number({"total_mass", "it ends when this has entered, to half the mass of a grain"}, v.totalMass,
           positive(unit::mass));
  f.integer({"seed", "the same seed gives the same grains"}, v.seed, 0, anySeed);
}
void describe(Fields& f, Outlet& v) {
  f.where(v.where);
  f.box({"region", "in which grains are removed"}, v.region);
}

// ---- bonds, drives

void describe(Fields& f, BondGroup& v) {
  f.where(v.where);
  f.text({"group", "of particles or clumps, by its name"}, v.group, true);
  f.text({"with", "the other group; not given: bonds within the group"}, v.with, false);
  f.number({"gap", "largest distance between surfaces of bonded grains, at the start"}, v.gap,
           notNegative(unit::length));
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
  f.number({"radius_ratio", "radius of the bond over that of the smaller grain"}, v.radiusRatio, positive(unit::none));
  f.number({"tensile_strength", "the bond breaks beyond it; never if not given"}, v.tensileStrength,
           positive(unit::pressure));
  f.number({"shear_strength", "the bond breaks beyond it; never if not given"}, v.shearStrength,
           positive(unit::pressure));
  f.number({"moment_contribution", "fraction of the bond's moments that counts in its stresses"}, v.momentContribution,
           between(0.0, 1.0));
  f.number({"damping_time", "damping coefficient over stiffness"}, v.dampingTime, notNegative(unit::time));
  f.flag({"contacts", "whether bonded grains have contact forces as well"}, v.contacts);
}
void describe(Fields& f, Drive& v) {
  f.where(v.where);
  f.text({"group", "of particles or clumps, by its name"}, v.group, true);
  rigidPath(f, v);
  f.functions({"spin", "of each about its own centre, if grains spin: may be expressions of the time t"}, v.spin,
              unit::spin);
}

}  // namespace dovetail::scene
