// The keys of a scene file: the one place that knows their names, limits and help.
#include "fields.hpp"

namespace dovetail::scene {

namespace {
constexpr const char* axisNames[] = {"x", "y", "z"};
constexpr const char* sides[] = {"x-", "x+", "y-", "y+", "z-", "z+"};
constexpr std::int64_t many = std::int64_t{1} << 40, anySeed = std::int64_t{1} << 53;

void poisson(Fields& f, double& value) {
  f.number({"poisson_ratio", "Poisson's ratio"}, value, between(-1.0, 0.5, true, true));
}
void young(Fields& f, double& value) {
  f.number({"youngs_modulus", "Young's modulus"}, value, positive(unit::pressure));
}
void density(Fields& f, double& value) { f.number({"density", "mass per volume"}, value, positive(unit::density)); }
void velocity(Fields& f, Vec3& value, const char* help) { f.vector({"velocity", help}, value, unit::velocity); }
}  // namespace

void Fields::axes(Key key, std::array<bool, 3>& value, bool needed) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < 3; ++k)
    if (value[k]) names.push_back(axisNames[k]);
  wordList(key, names, axisNames, needed);
  for (std::size_t k = 0; k < 3; ++k) value[k] = std::find(names.begin(), names.end(), axisNames[k]) != names.end();
}

// ---- contacts

void describe(Fields& f, Rolling& v) {
  f.number({"friction", "largest couple over effective radius times normal force"}, v.friction,
           notNegative(unit::none));
  f.number({"stiffness_ratio", "angular stiffness over normal stiffness times effective radius squared"},
           v.stiffnessRatio, positive(unit::none));
  f.number({"damping_ratio", "the same of the dashpots"}, v.dampingRatio, notNegative(unit::none));
}
void describe(Fields& f, LinearContact& v) {
  f.number({"stiffness", "of the normal spring"}, v.stiffness, positive(unit::stiffness));
  f.number({"tangential_stiffness", "of the tangential spring; 2/7 of the normal one if not given"},
           v.tangentialStiffness, positive(unit::stiffness));
}
void describe(Fields& f, HertzContact& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
}
void describe(Fields& f, ContactLaw& v) {
  static constexpr const char* laws[] = {"linear", "Hertz"};
  f.where(v.where);
  f.oneOf({"law", "normal force: a linear spring, or Hertz's with Mindlin's tangential stiffness"}, v.normal, laws);
  f.number({"restitution", "speed after over speed before a normal impact"}, v.restitution, between(0.0, 1.0, true));
  f.number({"friction", "Coulomb's coefficient"}, v.friction, notNegative(unit::none));
  f.number({"tangential_damping_ratio", "tangential dashpot over the normal one"}, v.tangentialDampingRatio,
           notNegative(unit::none));
  f.object({"rolling", "resistance to rolling"}, v.rolling);
  f.object({"twisting", "resistance to twisting"}, v.twisting);
}

// ---- space

void describe(Fields& f, Periodic& v) {
  f.box({"box", "its edges are the periods"}, v.box);
  f.axes({"axes", "along which space repeats"}, v.axes, true);
}
void describe(Fields& f, Domain& v) {
  static constexpr const char* policies[] = {"refuse", "remove"};
  f.box({"box", "where centres of grains may be"}, v.box);
  f.choice({"escape", "who leaves it ends the run, or leaves the scene"}, v.removes, policies);
}

// ---- grains

void describe(Fields& f, SizeRange& v) {
  f.number({"smallest", "radius"}, v.smallest, positive(unit::length));
  f.number({"largest", "radius; sizes between are equally likely"}, v.largest, positive(unit::length));
}
void describe(Fields& f, Lattice& v) {
  static constexpr const char* kinds[] = {"simple-cubic", "body-centred", "face-centred", "hexagonal"};
  f.choice({"lattice", "its kind"}, v.kind, kinds);
  f.box({"box", "that whole spheres fill from the lower corner"}, v.box);
  f.number({"radius", "of all spheres"}, v.radius, positive(unit::length));
  f.number({"distance", "of nearest centres; twice the radius if not given"}, v.distance, positive(unit::length));
}
void describe(Fields& f, RandomPacking& v) {
  f.box({"box", "that is filled; along periodic axes that it spans the packing repeats"}, v.box);
  f.object({"radius", "range of sizes"}, v.radius);
  f.number({"solid_fraction", "volume of the spheres over that of the box"}, v.solidFraction,
           between(0.0, 0.74, true, true));
  f.number({"overlap", "largest one that is left, over the smaller radius"}, v.overlap, between(0.0, 0.1, true));
  f.integer({"seed", "the same seed gives the same packing"}, v.seed, 0, anySeed);
}
void describe(Fields& f, Sphere& v) {
  f.vector({"at", "centre"}, v.at, unit::length);
  f.number({"radius", "of the sphere"}, v.radius, positive(unit::length));
  velocity(f, v.velocity, "at the start");
}
void describe(Fields& f, SphereList& v) { f.list({"spheres", "one by one"}, v.spheres, true); }
void describe(Fields& f, SphereFile& v) {
  f.file({"file", "CSV with columns x_m, y_m, z_m, radius_m and, if there, vx_m_per_s, vy_m_per_s, vz_m_per_s"},
         v.file);
}
void describe(Fields& f, Particles& v) {
  static constexpr const char* sources[] = {"lattice", "packing", "list", "csv"};
  f.where(v.where);
  f.oneOf({"from", "where the spheres come from"}, v.from, sources);
  density(f, v.density);
  velocity(f, v.velocity, "of all at the start");
}

// ---- walls

void describe(Fields& f, Plane& v) {
  f.vector({"point", "on the plane"}, v.point, unit::length);
  f.vector({"normal", "towards the grains, of any length"}, v.normal, unit::none);
}
void describe(Fields& f, BoxWalls& v) {
  f.box({"box", "grains are inside"}, v.box);
  f.wordList({"open", "sides without a wall"}, v.open, sides, false);
}
void describe(Fields& f, Cylinder& v) {
  f.vector({"point", "on the axis"}, v.point, unit::length);
  f.vector({"axis", "direction, of any length"}, v.axis, unit::none);
  f.number({"radius", "of the cylinder, which has no ends"}, v.radius, positive(unit::length));
  f.flag({"inside", "whether grains are inside"}, v.inside);
}
void describe(Fields& f, SphereWall& v) {
  f.vector({"centre", "of the sphere"}, v.centre, unit::length);
  f.number({"radius", "of the sphere"}, v.radius, positive(unit::length));
  f.flag({"inside", "whether grains are inside"}, v.inside);
}
void describe(Fields& f, SurfaceFile& v) {
  f.file({"file", "triangles: STL, OBJ, PLY, or VTP where the build has VTK"}, v.file);
  f.number({"scale", "metres per unit of the file"}, v.scale, positive(unit::none));
  f.vector({"shift", "after scaling"}, v.shift, unit::length);
  f.flag({"closed", "a closed skin that pushes outwards only; otherwise a sheet that pushes to both sides"}, v.closed);
}
void describe(Fields& f, Wall& v) {
  static constexpr const char* shapes[] = {"plane", "box", "cylinder", "sphere", "mesh"};
  f.where(v.where);
  f.oneOf({"shape", "of the wall"}, v.shape, shapes);
  velocity(f, v.velocity, "steady");
  f.vector({"angular_velocity", "steady, about the point or centre (of a mesh: the mean of its vertices)"},
           v.angularVelocity, unit::spin);
}

// ---- clumps, insertions, outlets

void describe(Fields& f, Clump& v) {
  f.where(v.where);
  f.list({"spheres", "that make the clump, in a frame of its own"}, v.spheres, true);
  density(f, v.density);
  f.vector({"at", "centre of mass"}, v.at, unit::length);
  velocity(f, v.velocity, "at the start");
  f.vector({"spin", "at the start"}, v.spin, unit::spin);
}
void describe(Fields& f, Insertion& v) {
  f.where(v.where);
  f.box({"region", "in which whole spheres appear where they touch nobody"}, v.region);
  f.object({"radius", "range of sizes"}, v.radius);
  density(f, v.density);
  velocity(f, v.velocity, "of newcomers");
  f.number({"number_per_second", "rate; this or mass_per_second"}, v.numberPerSecond, positive(unit::rate));
  f.number({"mass_per_second", "rate; this or number_per_second"}, v.massPerSecond, positive(unit::massRate));
  f.integer({"seed", "the same seed gives the same newcomers"}, v.seed, 0, anySeed);
}
void describe(Fields& f, Outlet& v) {
  f.where(v.where);
  f.box({"region", "whose grains leave the scene"}, v.region);
}

// ---- solids

void describe(Fields& f, BoxMesh& v) {
  static constexpr const char* shapes[] = {"hex8", "hex20", "hex27", "tet4", "tet10"};
  f.word({"cell", "shape of the cells; tetrahedra: six per brick"}, v.shape, shapes);
  f.cells({"cells", "numbers of bricks along x, y and z"}, v.cells);
  f.box({"box", "with the sets x-, x+, y-, y+, z-, z+ and skin"}, v.box);
}
void describe(Fields& f, MeshFile& v) {
  f.file({"file", "Gmsh .msh, Abaqus .inp, or .vtu where the build has VTK, with its sets"}, v.file);
  f.number({"scale", "metres per unit of the file"}, v.scale, positive(unit::none));
}
void describe(Fields& f, StVenantKirchhoff& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
}
void describe(Fields& f, NeoHookean& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
}
void describe(Fields& f, J2Plastic& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
  f.number({"yield_stress", "at first"}, v.yieldStress, positive(unit::pressure));
  f.number({"hardening", "yield stress gained per plastic strain"}, v.hardening, notNegative(unit::pressure));
}
void describe(Fields& f, DruckerPrager& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
  f.number({"cohesion", "shear strength without pressure"}, v.cohesion, notNegative(unit::pressure));
  f.number({"friction_angle", "below 90 deg"}, v.frictionAngle, {unit::angle, 0.0, 1.5, false, false});
  f.number({"dilatancy_angle", "not above the friction angle"}, v.dilatancyAngle, {unit::angle, 0.0, 1.5});
}
void describe(Fields& f, SolidMaterial& v) {
  static constexpr const char* laws[] = {"St-Venant-Kirchhoff", "neo-Hookean", "J2", "Drucker-Prager"};
  f.oneOf({"law", "elastic: the first two; with plastic flow: the others"}, v.law, laws);
  density(f, v.density);
}
void describe(Fields& f, Support& v) {
  f.where(v.where);
  f.text({"on", "name of a node set of the mesh"}, v.on, true);
  std::array<bool, 3> held{v.x, v.y, v.z};
  f.axes({"components", "that are held"}, held, false);
  v.x = held[0], v.y = held[1], v.z = held[2];
  velocity(f, v.velocity, "of the held components");
}
void describe(Fields& f, Solid& v) {
  static constexpr const char* meshes[] = {"box", "file"};
  static constexpr const char* formulations[] = {"standard", "mean-dilatation", "enhanced", "assumed-stress",
                                                 "reduced"};
  static constexpr const char* steppings[] = {"explicit", "implicit"};
  f.where(v.where);
  f.text({"name", "for couplings, reports and files: letters, digits, '_', '-' and '.', with a letter first"}, v.name,
         true);
  f.oneOf({"mesh", "a box of cells, or one from a file"}, v.mesh, meshes);
  f.object({"material", "of the solid"}, v.material);
  f.word({"formulation", "of the elements"}, v.formulation, formulations);
  f.flag({"gravity", "whether gravity acts on it"}, v.gravity);
  f.choice({"stepping", "how it is stepped in time"}, v.implicitSteps, steppings);
  velocity(f, v.velocity, "of all its nodes at the start");
  f.list({"supports", "nodes that are held or moved"}, v.supports);
}

// ---- couplings

void describe(Fields& f, SurfaceContact& v) {
  static constexpr const char* kernels[] = {"none", "advised"};
  f.text({"on", "name of a face set of the mesh"}, v.on, false);
  f.numberOrWord({"kernel", "width over which contacts are spread on the surface"}, v.kernel, positive(unit::length),
                 kernels);
  f.object({"contact", "law of these contacts; that of the grains if not given"}, v.contact);
}
void describe(Fields& f, Overlap& v) {
  static constexpr const char* profiles[] = {"half-cosine", "linear", "smooth"};
  static constexpr const char* constraints[] = {"penalty", "multiplier"};
  static constexpr const char* automatic[] = {"auto"};
  f.choice({"axis", "along which one model hands over to the other"}, v.axis, axisNames);
  f.number({"solid_border", "coordinate at which the solid ends, within the grains"}, v.solidBorder, any(unit::length));
  f.number({"particle_border", "coordinate at which the grains end, within the solid"}, v.particleBorder,
           any(unit::length));
  f.choice({"profile", "of the weights between the borders"}, v.profile, profiles);
  f.choice({"constraint", "what holds the two together"}, v.multipliers, constraints);
  f.numberOrWord({"penalty", "stiffness per volume"}, v.penalty, positive(unit::penalty), automatic);
  f.number({"kernel", "width over which gaps are averaged; 0: none"}, v.kernel, notNegative(unit::length));
}
void describe(Fields& f, Coupling& v) {
  static constexpr const char* kinds[] = {"surface", "overlap"};
  f.where(v.where);
  f.oneOf({"type", "contacts on the surface of a solid, or an overlap with it"}, v.kind, kinds);
  f.text({"solid", "name of the solid"}, v.solid, true);
}

// ---- the run

void describe(Fields& f, Settle& v) {
  f.number({"kinetic", "kinetic over elastic energy below which all is at rest"}, v.kinetic, between(0.0, 1.0, true));
  f.integer({"windows", "windows of steps after which it is given up"}, v.windows, 1, many);
}
void describe(Fields& f, RunFor& v) { f.number({"time", "that is simulated"}, v.time, positive(unit::time)); }
void describe(Fields& f, Stage& v) {
  static constexpr const char* kinds[] = {"settle", "run"};
  f.where(v.where);
  f.oneOf({"do", "bring all to rest by kinetic damping, or run for a time"}, v.kind, kinds);
}
void describe(Fields& f, Steps& v) {
  static constexpr const char* automatic[] = {"auto"};
  f.where(v.where);
  f.numberOrWord({"dt", "time step of the grains"}, v.dt, positive(unit::time), automatic);
  f.number({"safety", "share of the critical step that \"auto\" takes"}, v.safety, between(0.0, 1.0, true));
  f.integer({"per_window", "K: steps of the grains per step of the solids"}, v.stepsPerWindow, 1, 100000);
  f.integer({"threads", "0: one per processor; results are the same for any number"}, v.threads, 0, 1024);
}
void describe(Fields& f, Scene& v) {
  f.text({"title", "one line about the scene"}, v.title, false);
  f.parameters({"let", "parameters of expressions: a number with or without a unit, or an expression of those above"});
  f.vector({"gravity", "acceleration"}, v.gravity, unit::acceleration);
  f.object({"contact", "law of contacts between grains, with walls and with solids"}, v.contact);
  f.object({"periodic", "space that repeats"}, v.periodic);
  f.object({"domain", "where grains may be"}, v.domain);
  f.list({"particles", "groups of spheres"}, v.particles);
  f.list({"walls", "rigid walls"}, v.walls);
  f.list({"clumps", "rigid bodies of spheres"}, v.clumps);
  f.list({"insertions", "grains that enter"}, v.insertions);
  f.list({"outlets", "regions in which grains leave"}, v.outlets);
  f.list({"solids", "bodies of finite elements"}, v.solids);
  f.list({"couplings", "between grains and solids"}, v.couplings);
  f.object({"steps", "time steps"}, v.steps);
  f.list({"stages", "what is done, in this order"}, v.stages, true);
  f.object({"output", "what is written"}, v.output);
}

}  // namespace dovetail::scene
