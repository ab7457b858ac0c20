// Keys of solids and of their couplings to grains.
#include "keys.hpp"

namespace dovetail::scene {

// ---- solids

void describe(Fields& f, BoxMesh& v) {
  static constexpr const char* shapes[] = {"hex8", "hex20", "hex27", "tet4", "tet10", "quad4", "quad8"};
  f.word({"cell", "shape of the cells; tetrahedra: six per brick; quad4, quad8: plane strain, one cell along z"},
         v.shape, shapes);
  f.cells({"cells", "numbers of bricks along x, y and z"}, v.cells);
  f.box({"box",
         "extent; the mesh has the sets x-, x+, y-, y+, z-, z+ and skin, in plane strain those along x and y and skin; "
         "the extent along z is then its thickness"},
        v.box);
  f.box({"hole", "cells whose centres lie in it are left out; the faces that this bares are the set hole"}, v.hole);
}
void describe(Fields& f, MeshFile& v) {
  f.file(
      {"file", "Gmsh .msh, Abaqus .inp, Exodus .e, .exo, .ex2 or .g, or .vtu where the build has VTK, with its sets"},
      v.file);
  f.number({"scale", "metres per unit of the file"}, v.scale, positive(unit::none));
}
void describe(Fields& f, TetrahedraMesh& v) {
  f.file({"file", "closed surface: STL, OBJ, PLY, or VTP where the build has VTK; the set skin is its boundary"},
         v.file);
  f.number({"scale", "metres per unit of the file"}, v.scale, positive(unit::none));
  f.number({"size", "largest circumradius of the tetrahedra, and largest edge along sharp edges"}, v.size,
           positive(unit::length));
  f.number(
      {"surface_distance", "largest distance of the boundary from the surface; a twentieth of the size if not given"},
      v.surfaceDistance, positive(unit::length));
}
void describe(Fields& f, StVenantKirchhoff& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
}
void describe(Fields& f, NeoHookean& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
}
void describe(Fields& f, YieldPoint& v) {
  f.number({"plastic_strain", "accumulated; above that of the point before"}, v.plasticStrain, positive(unit::none));
  f.number({"yield_stress", "there"}, v.yieldStress, positive(unit::pressure));
}
void describe(Fields& f, J2Plastic& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
  f.number({"yield_stress", "initial value"}, v.yieldStress, positive(unit::pressure));
  f.number({"hardening", "increase of the yield stress per plastic strain"}, v.hardening, notNegative(unit::pressure));
  f.list({"hardening_curve", "in place of hardening: further points, straight between them and level behind the last"},
         v.hardeningCurve);
  f.number({"kinematic_modulus", "increase of the back stress per plastic strain (kinematic hardening)"},
           v.kinematicModulus, notNegative(unit::pressure));
  f.number(
      {"recovery", "of the back stress, which saturates at kinematic_modulus/recovery (Armstrong & Frederick 1966)"},
      v.recovery, notNegative(unit::none));
}
void describe(Fields& f, CohesionPoint& v) {
  f.number({"plastic_strain", "accumulated, in shear gamma/sqrt(3); above that of the point before"}, v.plasticStrain,
           positive(unit::none));
  f.number({"cohesion", "there"}, v.cohesion, positive(unit::pressure));
}
void describe(Fields& f, DruckerPrager& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
  f.number({"cohesion", "shear strength without pressure"}, v.cohesion, notNegative(unit::pressure));
  f.list({"cohesion_curve",
          "further points, straight between them and level behind the last; where it falls, give the solid a gradient"},
         v.cohesionCurve);
  f.number({"friction_angle", "below 90 deg"}, v.frictionAngle, {unit::angle, 0.0, 1.5, false, false});
  f.number({"dilatancy_angle", "not above the friction angle"}, v.dilatancyAngle, {unit::angle, 0.0, 1.5});
}
void describe(Fields& f, AxialSprings& v) { young(f, v.youngsModulus); }
void describe(Fields& f, DeformedMetric& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
}
void describe(Fields& f, GrainCells& v) {
  static constexpr const char* tangents[] = {"elastic", "frictional", "Voigt", "probed", "numerical", "averaged"};
  static constexpr const char* deals[] = {"in turn", "by depth"};
  f.text({"cells", "name of the cells"}, v.cells, true);
  f.choice({"deal",
            "which cell a point gets: one after the other; or one that was pressed on by the weight above it, from the "
            "highest node of the solid down, so that a bed under gravity starts at rest"},
           v.deal, deals);
  f.choice({"tangent", "of load steps: derivative of the stress of the cells"}, v.tangent, tangents);
  f.number({"inertial_number", "of the paths of the cells in load steps"}, v.inertialNumber, between(0.0, 1e-2, true));
  f.number({"strain_per_step", "largest, of the steps of the grains while the solid moves"}, v.strainPerStep,
           between(0.0, 1e-3, true));
  f.number({"damping", "fraction of the forces on grains against their motion while the solid moves"}, v.damping,
           between(0.0, 1.0, false, true));
}
void describe(Fields& f, SolidMaterial& v) {
  static constexpr const char* laws[] = {"St-Venant-Kirchhoff", "neo-Hookean",     "J2",   "Drucker-Prager",
                                         "axial-springs",       "deformed-metric", "cells"};
  f.oneOf({"law",
           "elastic, but J2 and Drucker-Prager elastic-plastic; axial-springs: as a cubic lattice of grains; "
           "deformed-metric: Hooke's law by the metric of the deformed body, without a potential (Cheng et al. 2023, "
           "Eq. 34); cells: a cell of grains at every point, which has the density too"},
          v.law, laws);
  if (std::holds_alternative<GrainCells>(v.law)) return;
  density(f, v.density);
  f.number(
      {"damping_time", "viscosities over elastic moduli: the damping ratio of a mode of frequency f is pi*f times it"},
      v.dampingTime, notNegative(unit::time));
}
void describe(Fields& f, MaterialRegion& v) {
  f.where(v.where);
  f.text({"elements", "element set: of the mesh, or one of the sets of the solid"}, v.elements, true);
  f.object({"material", "of these elements"}, v.material);
}
void describe(Fields& f, PlaceInBox& v) { f.box({"box", "including its boundary"}, v.box); }
void describe(Fields& f, PlaceOnPlane& v) {
  f.vector({"point", "on the plane"}, v.point, unit::length);
  f.vector({"normal", "of any length"}, v.normal, unit::none);
  f.number({"tolerance", "distance to either side; 1e-6 of the mesh's extent if not given"}, v.tolerance,
           positive(unit::length));
}
void describe(Fields& f, PlaceInSphere& v) {
  f.vector({"centre", "of the sphere"}, v.centre, unit::length);
  f.number({"radius", "of the sphere"}, v.radius, positive(unit::length));
  f.number({"inner_radius", "of a sphere that is left out"}, v.innerRadius, notNegative(unit::length));
}
void describe(Fields& f, PlaceInCylinder& v) {
  f.vector({"point", "on the axis"}, v.point, unit::length);
  f.vector({"axis", "direction, of any length"}, v.axis, unit::none);
  f.number({"radius", "of the cylinder, which is infinitely long"}, v.radius, positive(unit::length));
  f.number({"inner_radius", "of a cylinder that is left out"}, v.innerRadius, notNegative(unit::length));
}
void describe(Fields& f, FacesTowards& v) {
  f.vector({"direction", "of any length"}, v.direction, unit::none);
  f.number({"angle", "largest, between it and the outer normals of boundary faces"}, v.angle,
           {unit::angle, 0.0, 3.2, true});
}
void describe(Fields& f, CommonPart& v) {
  f.text({"of", "set: of the mesh, or above"}, v.of, true);
  f.text({"and", "set: of the mesh, or above"}, v.with, true);
}
void describe(Fields& f, PlaceAtSide& v) { f.word({"side", "at the least or largest coordinate"}, v.side, sides); }
void describe(Fields& f, NamedSet& v) {
  static constexpr const char* places[] = {"side", "box", "plane", "sphere", "cylinder", "faces", "common"};
  f.where(v.where);
  f.text({"name", "for supports, loads, ties, regions, planes and couplings"}, v.name, true);
  f.oneOf({"place",
           "of its nodes; it has the elements and boundary faces all of whose nodes are in it; faces: by their "
           "direction; common: what two sets have in common"},
          v.place, places);
}
void describe(Fields& f, Support& v) {
  f.where(v.where);
  f.text({"on", "node set: of the mesh, or one of the sets of the solid"}, v.on, true);
  std::array<bool, 3> held{v.x, v.y, v.z};
  f.axes({"components", "that are held"}, held, false);
  v.x = held[0], v.y = held[1], v.z = held[2];
  f.functions({"velocity", "may be expressions of the time t"}, v.velocity, unit::velocity);
  f.functions(
      {"displacement", "in place of a velocity: expressions of the time t and the undeformed place x, y, z", true},
      v.displacement, unit::length);
  f.object({"turn", "rotation of the nodes about an axis, beside their displacement"}, v.turn);
  f.vector({"point", "on the axis of the turn"}, v.point, unit::length);
}
void describe(Fields& f, PressureLoad& v) {
  f.function({"pressure", "on the faces; may be an expression of the time t and the undeformed place x, y, z", true},
             v.pressure, any(unit::pressure));
  f.flag({"follows", "whether it acts on the deformed faces (follower load)"}, v.follows);
}
void describe(Fields& f, TractionLoad& v) {
  f.functions({"traction",
               "force per undeformed area of the faces; may be expressions of the time t and the undeformed place x, "
               "y, z",
               true},
              v.traction, unit::pressure);
}
void describe(Fields& f, NodalLoad& v) {
  f.functions({"force", "in all, in equal parts on the nodes; may be expressions of the time t"}, v.force, unit::force);
}
void describe(Fields& f, Load& v) {
  static constexpr const char* kinds[] = {"pressure", "traction", "force"};
  f.where(v.where);
  f.text({"on", "face set, of forces node set: of the mesh, or one of the sets of the solid"}, v.on, true);
  f.oneOf({"type", "normal to the faces, in a given direction, or a force on nodes"}, v.kind, kinds);
}
void describe(Fields& f, MeshTie& v) {
  f.where(v.where);
  f.text({"nodes", "node set that is tied to the faces: that of the finer mesh"}, v.nodes, true);
  f.text({"faces", "face set"}, v.faces, true);
  f.number({"tolerance", "largest distance of a node from the faces"}, v.tolerance, positive(unit::length));
}
void describe(Fields& f, SolidPlane& v) {
  static constexpr const char* automatic[] = {"auto"};
  f.where(v.where);
  f.text({"on", "face set: of the mesh, or one of the sets of the solid"}, v.on, false);
  f.vector({"point", "on the plane"}, v.point, unit::length);
  f.vector({"normal", "towards the solid, of any length"}, v.normal, unit::none);
  path(f, v.velocity, v.displacement);
  f.numberOrWord({"stiffness",
                  "pressure per penetration; auto: ten times the confined modulus over the size of the faces, with "
                  "explicit steps once"},
                 v.stiffness, positive(unit::pressurePerLength), automatic);
  f.number({"friction", "Coulomb's coefficient"}, v.friction, notNegative(unit::none));
}
void describe(Fields& f, SolidGradient& v) {
  f.number({"modulus",
            "D: a layer whose shear stress falls by H per shear strain has a band of 2*sqrt(D/H)*(pi - "
            "atan(sqrt(H/G)))"},
           v.modulus, positive(unit::force));
}
void describe(Fields& f, StateOfSolid& v) {
  f.file({"file",
          "checkpoint with a solid of this name and the same mesh, material and formulation: initial displacements, "
          "velocities and plastic strains; displacements of supports count from there"},
         v.file);
}
void describe(Fields& f, Solid& v) {
  static constexpr const char* meshes[] = {"box", "file", "tetrahedra", "points"};
  static constexpr const char* formulations[] = {"standard", "mean-dilatation", "enhanced", "assumed-stress",
                                                 "reduced"};
  static constexpr const char* steppings[] = {"explicit", "implicit"};
  static constexpr const char* solvers[] = {"auto", "direct", "conjugate-gradients", "multigrid"};
  f.where(v.where);
  f.text({"name", "for couplings, reports and files: letters, digits, '_', '-' and '.', with a letter first"}, v.name,
         true);
  f.oneOf({"mesh",
           "a box of cells, one from a file, tet4 in a closed surface where the build has CGAL in the program, or "
           "material points on a grid that is renewed as they travel"},
          v.mesh, meshes);
  f.object({"material", "of the solid"}, v.material);
  f.list({"regions", "elements of other materials"}, v.regions);
  f.word({"formulation", "of the elements"}, v.formulation, formulations);
  f.object({"gradient",
            "energy of the gradient of F, which gives bands of softening materials a width; for quad4, reduced "
            "quad8, hex8 and material points"},
           v.gradient);
  f.flag({"gravity", "whether gravity acts on it"}, v.gravity);
  f.choice({"stepping", "time integration"}, v.implicitSteps, steppings);
  f.choice({"linear_solver",
            "of implicit steps and load steps; auto: direct as long as the factors take no more than 2 GiB, else "
            "multigrid where the build has PETSc, or conjugate gradients: both take a fraction of the memory"},
           v.linearSolver, solvers);
  f.number({"consistent_mass",
            "fraction of the consistent mass, the rest is lumped; if not given, 1 with implicit steps, else 0; (1 - "
            "(d/h)^2)/2 gives elements of edge h the wave dispersion of a lattice of grains of diameter d"},
           v.massFraction, between(0.0, 1.0));
  f.number(
      {"mass_damping", "force over mass and velocity: the damping ratio of a mode of frequency f is it over 4*pi*f"},
      v.massDamping, notNegative(unit::rate));
  f.object({"state", "initial state, of another run"}, v.state);
  velocity(f, v.velocity, "of all its nodes at the start, added to that of the state");
  f.list({"sets", "nodes and faces by their place"}, v.sets);
  f.list({"supports", "nodes that are held or moved"}, v.supports);
  f.list({"loads", "on faces and nodes"}, v.loads);
  f.list({"ties", "of parts of the mesh that do not share nodes"}, v.ties);
  f.list({"planes", "rigid planes that faces of the solid cannot pass"}, v.planes);
}

// ---- couplings

constexpr const char* kernelShapes[] = {"lucy", "gauss"};

void describe(Fields& f, SurfaceContact& v) {
  static constexpr const char* kernels[] = {"none", "advised"};
  static constexpr const char* corrections[] = {"none", "linear", "symmetric"};
  static constexpr const char* transfers[] = {"adjoint", "spread"};
  static constexpr const char* surfaces[] = {"flat", "smooth"};
  static constexpr const char* rules[] = {"projected", "deepest"};
  f.text({"on", "face set: of the mesh, or one of the sets of the solid"}, v.on, false);
  f.numberOrWord({"kernel",
                  "width over which contact forces are spread on the surface; none: forces on the nodes of single "
                  "facets, whose compliance grows with refinement"},
                 v.kernel.width, positive(unit::length), kernels);
  f.choice({"kernel_shape", "of the kernel"}, v.kernel.shape, kernelShapes);
  f.choice({"kernel_correction",
            "at edges of the surface: linear keeps first moments, symmetric keeps uniform loads uniform; must be none "
            "with the transfer spread"},
           v.kernel.correction, corrections);
  f.choice({"transfer",
            "adjoint: the same weights for gap and load, which conserves energy; spread: the gap of single facets, and "
            "only the load is spread (Cheng et al. 2023, Eqs. 14 and 15)"},
           v.spread, transfers);
  f.choice({"surface", "flat facets, or B-spline patches through them without edges; smooth needs faces of four nodes"},
           v.smooth, surfaces);
  f.choice({"edges",
            "where a grain touches several facets: one contact, projected clear of all, which has a potential; or the "
            "deepest contact, the mean of all where all are faces (code of Cheng et al. 2023)"},
           v.edges, rules);
  f.object({"contact", "law of these contacts; that of the grains if not given"}, v.contact);
  contactMaterial(f, v.contactMaterial);
}
void describe(Fields& f, Overlap& v) {
  static constexpr const char* profiles[] = {"half-cosine", "linear", "smooth"};
  static constexpr const char* constraints[] = {"penalty", "multiplier", "dashpot"};
  static constexpr const char* matrices[] = {"lumped", "consistent"};
  static constexpr const char* orders[] = {"symmetric", "staggered"};
  static constexpr const char* gaps[] = {"at-grains", "nodal"};
  static constexpr const char* rows[] = {"per-node", "per-element"};
  static constexpr const char* reaches[] = {"overlap", "outside"};
  static constexpr const char* automatic[] = {"auto"};
  f.choice({"axis", "across the planes between which the weights change from one model to the other"}, v.axis,
           axisNames);
  f.number(
      {"solid_border",
       "coordinate of the plane at which the solid ends, within the grains; both borders or both boxes are needed"},
      v.solidBorder, any(unit::length));
  f.number({"particle_border", "coordinate of the plane at which the grains end, within the solid"}, v.particleBorder,
           any(unit::length));
  f.box({"solid_box", "in place of the planes: where the solid ends, around grains alone"}, v.solidBox);
  f.box(
      {"particle_box",
       "around solid_box: where the grains end, within the solid; sides of the same place, beyond the solid, are open"},
      v.particleBox);
  f.choice({"profile", "of the weights between the borders"}, v.profile, profiles);
  f.number(
      {"floor", "least weight of either model at the borders; a larger one allows larger steps of the grains there"},
      v.floor, between(0.0, 0.5, false, true));
  f.choice({"constraint", "how the gap is held; dashpot: a penalty on its increment per step"}, v.constraint,
           constraints);
  f.numberOrWord(
      {"penalty", "stiffness per volume; must be given for a dashpot, which applies it to increments of the gap"},
      v.penalty, positive(unit::penalty), automatic);
  f.choice({"dashpot_matrix", "of a dashpot: row sums, or products of shape functions"}, v.consistentDashpot, matrices);
  f.choice({"order", "of a dashpot on an implicit solid: forces of the same macro step, or of the one before"},
           v.staggered, orders);
  f.choice({"gap", "where the two fields are compared: at the grains, where linear fields have no gap, or at nodes"},
           v.gap, gaps);
  f.choice({"rows", "of the gap: one per node, or one per element and corner"}, v.perElement, rows);
  f.number({"kernel", "width over which gaps are averaged; 0: none"}, v.kernel, notNegative(unit::length));
  f.choice({"kernel_shape", "of the kernel"}, v.kernelShape, kernelShapes);
  f.flag({"kernel_normalised", "whether kernels cut at a border are normalised"}, v.normalised);
  f.choice({"kernel_reach",
            "kernels over grains of the overlap, or also over those outside; the latter needs the gap at nodes"},
           v.reachOut, reaches);
  f.number({"absorber", "damping rate of grain motions that the mesh cannot represent; 0: none"}, v.absorber,
           notNegative(unit::rate));
  f.flag({"initial_equilibrium",
          "whether the solid starts deformed, in equilibrium with its loads and the grains, which should be at rest"},
         v.initialEquilibrium);
}
void describe(Fields& f, Coupling& v) {
  static constexpr const char* kinds[] = {"surface", "overlap", "points"};
  f.where(v.where);
  f.oneOf({"type",
           "contacts on the surface of a solid, an overlap with it, or contacts of its material points with grains, "
           "walls and points of other solids"},
          v.kind, kinds);
  f.text({"solid", "name of the solid"}, v.solid, true);
}

}  // namespace dovetail::scene
