// Elements of any shape and material as a term of a model.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/fem/elements/critical_element.hpp"
#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/fem/laws/point_material.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/term.hpp"

namespace dovetail::fem {

enum class Formulation {
  /// Displacements alone; hex8 2×2×2, hex20 and hex27 3×3×3, tet4 1, tet10 4, quad4 2×2, quad8 3×3 points.
  standard,
  /// Bricks and plane cells: the dilatation is a field of its own, constant in hex8 and quad4 (Simo, Taylor & Pister
  /// 1985),
  /// linear in hex20, hex27 and quad8; F̄ = (θ/J)^⅓ F with θ the projection of J. Does not lock as ν → ½; one
  /// layer of hex8 bends 1.4 times too softly. Derives from
  /// the potential ∫W(F̄). Samples show F̄ and P(F̄).
  meanDilatation,
  /// hex8 only: enhanced strain with transposed Wilson modes (Glaser & Armero 1997): nine modes in each element, F =
  /// F_u + F_α. Bends without locking and hardly locks as ν → ½ (3 % of a bent block at 0.49999); the transposition
  /// takes away the hourglass modes in
  /// compression of the older enhanced bricks.
  enhanced,
  /// hex8 and StVenantKirchhoff only: assumed stress (hybrid8; Pian & Tong 1986: 18 modes, 18 = 24 − 6 of them with
  /// stiffness). As exact in bending
  /// as `enhanced` for a tenth of the time. Samples show the stress of the displacements, not the assumed one.
  assumedStress,
  /// hex8: one point and hourglass stiffness; its energy is reported on its own; n layers bend 1/(1 − 1/n²) times too
  /// softly. quad8: 2×2 points and nothing else;
  /// the
  /// one mode without stiffness that this leaves to an element cannot pass to a neighbour.
  reduced
};
const char* name(Formulation formulation);

struct SolidOptions {
  Formulation formulation = Formulation::standard;
  std::string elementSet{};  ///< empty = all elements of the mesh
  std::string name = "elastic";
  double hourglassFraction = 0.05;  ///< of the shear stiffness, for `reduced` hex8
  /// Per node of the mesh, 0 … 1, interpolated to the points of every integral (energy, force, mass, tangent): the
  /// fraction of the solid where it overlaps something else. Empty = 1. Elements whose nodes all have 0 are left out.
  std::vector<double> fraction{};
  /// Each rank of team() computes a part of the elements, of a material, and has a part of the matrix: for solids that
  /// multigrid solves. All ranks then make all calls.
  bool onRanks = false;
};

/// Elements of a mesh with one material or one field of points.
class Solid : public Term {
public:
  bool actsWithin() const final { return true; }
  bool isBody() const final { return true; }
  /// Nothing: stableStep() says what an explicit step can be.
  void addStiffness(const Nodes&, const Instant&, std::span<double>) final {}
  virtual std::size_t size() const = 0;
  /// Elements of each rank that shares them.
  virtual std::vector<std::size_t> sizesOnRanks() const { return {size()}; }
  /// Bytes of the caches and of history.
  virtual std::size_t memory() const = 0;
  /// Null for a field of points.
  virtual const PointMaterial* material() const = 0;
  /// Null for a material; its points are those of sample(), in the same order.
  virtual const PointField* field() const = 0;
  /// Reference density, kg/m³.
  virtual double density() const = 0;
  /// Energy in hourglass stiffness alone, J (part of energy()).
  virtual double hourglassEnergy(const Nodes&) { return 0.0; }
  /// 2/ω of the stiffest single element at the present displacement, with its lumped mass: never above the limit of the
  /// assembled solid. Names the element by its number in the mesh.
  std::optional<StableStep> stableStep(const Nodes& nodes) override = 0;
  /// Stored energy of each element, J.
  virtual std::vector<double> elementEnergies(const Nodes& nodes, const Instant& now) = 0;
  /// Weight of the integrals per node of the mesh; empty = 1.
  virtual std::span<const double> fraction() const = 0;
  virtual ElementShape shape() const = 0;
  virtual Formulation formulation() const = 0;
  /// Number in the mesh of element e.
  virtual int number(std::size_t e) const = 0;

  /// What is known at the quadrature points, for output and tests.
  struct Sample {
    std::vector<int> element;     ///< number in the mesh
    std::vector<Vec3> X;          ///< m
    std::vector<double> volume;   ///< reference, m³
    std::vector<double> F, P;     ///< nine per point, row-major
    std::vector<double> energy;   ///< J/m³
    std::vector<double> history;  ///< committed, historySize per point; empty for a field of points
  };
  virtual Sample sample(const Nodes& nodes, const Instant& now) = 0;
};

/// @throws InputError for an invalid mesh, a set that does not exist or is empty, a formulation that a shape does not
/// have, fractions that are not one per node or not within 0 … 1, or 0 throughout
std::shared_ptr<Solid> makeSolid(const SolidMesh& mesh, std::shared_ptr<const PointMaterial> material,
                                 const SolidOptions& options = {});

/// The same with points that own their states: the formulations standard, meanDilatation and reduced. The field is
/// opened, and belongs to this solid alone.
std::shared_ptr<Solid> makeSolid(const SolidMesh& mesh, std::shared_ptr<PointField> field,
                                 const SolidOptions& options = {});

}  // namespace dovetail::fem
