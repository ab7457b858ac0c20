// A rigid plane that faces of a solid cannot pass.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "dovetail/fem/laws/point_material.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/term.hpp"

namespace dovetail::fem {

/// The solid is on the side to which the normal points.
struct Plane {
  Vec3 point;                            ///< of the plane at motion zero, m
  Vec3 normal;                           ///< any length > 0
  std::function<Vec3(double)> motion{};  ///< displacement of the plane at time t, m; empty = it rests
};

struct ContactOptions {
  double penalty = 0.0;  ///< ε: pressure per penetration, Pa/m, > 0; contactPenalty() proposes one
  /// Multipliers λ grow in augment() until nothing penetrates deeper than gapTolerance: the penalty then decides about
  /// convergence only.
  bool augmented = false;
  double gapTolerance = 0.0;           ///< m, > 0 if augmented
  int maxAugmentations = 50;           ///< per step; then the step is taken as it is
  double friction = 0.0;               ///< Coulomb's coefficient
  double tangentialPenalty = 0.0;      ///< ε_T, Pa/m; 0 = penalty
  std::string name = "contact plane";  ///< its channel in the ledger
};

/// Contact of faces with a plane, at the quadrature points of the faces and per reference area. Pressure
/// p = max(0, λ − ε g) with the gap g = n · (x − point − motion), traction p n. The force is the negative gradient of
/// W = ∫ (p² − λ²) / 2ε dA; a uniform gap therefore gives the nodal forces of a uniform pressure for every shape.
///
/// Friction by springs ε_T that slip at μ p, with their elastic energy stored; they are slack in the state in which the
/// term is first used. commit() books the dissipation of friction, half the sum of both tractions of a step times the
/// slip, and what a change of multipliers does to W; workOfMotion() the work of the moving plane, the mean of both
/// forces of a step times its motion.
class ContactPlane : public Term {
public:
  struct Report {
    Vec3 force;                    ///< on the solid, N
    double area = 0.0;             ///< reference area under pressure, m²
    double deepest = 0.0;          ///< largest penetration −g where there is pressure, m
    double largestPressure = 0.0;  ///< Pa
  };
  virtual Report report(const Nodes& nodes, const Instant& now) const = 0;
};

/// A penalty for faces of a material, Pa/m: ten times its confined modulus (Pa; moduliAtRest) over the mean size √A of
/// the faces (of lines: their length).
/// A pressure then penetrates by a tenth of what it compresses a layer of cubes. Explicit steps shrink to about a third
/// by it; a tenth of it leaves them.
/// @throws InputError for no faces, a node that does not exist
double contactPenalty(const SolidMesh& mesh, std::span<const Face> faces, double confinedModulus);

/// @throws InputError for no faces, a node that does not exist, a normal without length, options out of range
std::shared_ptr<ContactPlane> makeContactPlane(const SolidMesh& mesh, std::span<const Face> faces, const Plane& plane,
                                               const ContactOptions& options);

}  // namespace dovetail::fem
