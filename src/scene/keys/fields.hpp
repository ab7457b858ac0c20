// The functions describe(Fields&, …) of the structures of a scene.
#pragma once

#include "dovetail/scene/fields.hpp"
#include "dovetail/scene/scene.hpp"

namespace dovetail::scene {

// keys_grains.cpp, keys_solids.cpp, keys.cpp
void describe(Fields& f, Rolling& v);
void describe(Fields& f, LinearContact& v);
void describe(Fields& f, HertzContact& v);
void describe(Fields& f, ElasticPlasticContact& v);
void describe(Fields& f, Adhesion& v);
void describe(Fields& f, LiquidBridge& v);
void describe(Fields& f, ContactLaw& v);
void describe(Fields& f, PairLaw& v);
void describe(Fields& f, SizeRange& v);
void describe(Fields& f, NormalSizes& v);
void describe(Fields& f, LogNormalSizes& v);
void describe(Fields& f, SizeClass& v);
void describe(Fields& f, SizeClasses& v);
void describe(Fields& f, Sieve& v);
void describe(Fields& f, SieveCurve& v);
void describe(Fields& f, Sizes& v);
void describe(Fields& f, Lattice& v);
void describe(Fields& f, CylinderRegion& v);
void describe(Fields& f, RandomPacking& v);
void describe(Fields& f, Sphere& v);
void describe(Fields& f, MovingSphere& v);
void describe(Fields& f, SphereList& v);
void describe(Fields& f, SphereFile& v);
void describe(Fields& f, SphereFrame& v);
void describe(Fields& f, GrainsOfState& v);
void describe(Fields& f, Particles& v);
void describe(Fields& f, Plane& v);
void describe(Fields& f, BoxWalls& v);
void describe(Fields& f, Cylinder& v);
void describe(Fields& f, SphereWall& v);
void describe(Fields& f, TriangleFiles& v);
void describe(Fields& f, SurfaceFile& v);
void describe(Fields& f, Turn& v);
void describe(Fields& f, KeptForce& v);
void describe(Fields& f, KeptPressure& v);
void describe(Fields& f, KeptTorque& v);
void describe(Fields& f, Servo& v);
void describe(Fields& f, Wall& v);
void describe(Fields& f, WallChange& v);
void describe(Fields& f, Clump& v);
void describe(Fields& f, ClumpKind& v);
void describe(Fields& f, Insertion& v);
void describe(Fields& f, Outlet& v);
void describe(Fields& f, BondGroup& v);
void describe(Fields& f, Drive& v);
void describe(Fields& f, BoxMesh& v);
void describe(Fields& f, MeshFile& v);
void describe(Fields& f, TetrahedraMesh& v);
void describe(Fields& f, StVenantKirchhoff& v);
void describe(Fields& f, NeoHookean& v);
void describe(Fields& f, YieldPoint& v);
void describe(Fields& f, J2Plastic& v);
void describe(Fields& f, DruckerPrager& v);
void describe(Fields& f, AxialSprings& v);
void describe(Fields& f, DeformedMetric& v);
void describe(Fields& f, SolidMaterial& v);
void describe(Fields& f, MaterialRegion& v);
void describe(Fields& f, PlaceInBox& v);
void describe(Fields& f, PlaceOnPlane& v);
void describe(Fields& f, PlaceInSphere& v);
void describe(Fields& f, PlaceInCylinder& v);
void describe(Fields& f, FacesTowards& v);
void describe(Fields& f, CommonPart& v);
void describe(Fields& f, PlaceAtSide& v);
void describe(Fields& f, NamedSet& v);
void describe(Fields& f, Support& v);
void describe(Fields& f, PressureLoad& v);
void describe(Fields& f, TractionLoad& v);
void describe(Fields& f, NodalLoad& v);
void describe(Fields& f, Load& v);
void describe(Fields& f, MeshTie& v);
void describe(Fields& f, SolidPlane& v);
void describe(Fields& f, StateOfSolid& v);
void describe(Fields& f, Solid& v);
void describe(Fields& f, SurfaceContact& v);
void describe(Fields& f, Overlap& v);
void describe(Fields& f, Coupling& v);
void describe(Fields& f, Periodic& v);
void describe(Fields& f, Domain& v);
void describe(Fields& f, Damping& v);
void describe(Fields& f, Relax& v);
void describe(Fields& f, RunFor& v);
void describe(Fields& f, Statics& v);
void describe(Fields& f, FindModes& v);
void describe(Fields& f, LoadChange& v);
void describe(Fields& f, SupportChange& v);
void describe(Fields& f, Changes& v);
void describe(Fields& f, Stage& v);
void describe(Fields& f, Steps& v);
void describe(Fields& f, GrainProbe& v);
void describe(Fields& f, NodeProbe& v);
void describe(Fields& f, WallProbe& v);
void describe(Fields& f, SolidProbe& v);
void describe(Fields& f, DriveProbe& v);
void describe(Fields& f, SupportProbe& v);
void describe(Fields& f, RegionProbe& v);
void describe(Fields& f, Probe& v);
void describe(Fields& f, Output& v);
void describe(Fields& f, Scene& v);

}  // namespace dovetail::scene
