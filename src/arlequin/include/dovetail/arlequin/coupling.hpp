// A volume coupling: overlap, projection and constraint, made together and renewed on events.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/arlequin/absorber.hpp"
#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/arlequin/coupling_options.hpp"
#include "dovetail/arlequin/gap_operator.hpp"
#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/motion/motion.hpp"

namespace dovetail::arlequin {

/// The solid of a volume coupling.
class Solid {
public:
  /// Masses are set here: those of the elements, weighted by their share 1 − w, `massShare` of them consistent.
  /// @param model  one solid of hex8 with an elastic law of the hand-written kernels, supports at rest
  /// @throws InputError naming what else the model has, or a node without mass
  Solid(const fem::SolidMesh& mesh, std::unique_ptr<fem::Model> model, double massShare = 0.0);

  fem::SolidMesh mesh;
  fem::Nodes& nodes() { return model_->nodes; }
  const fem::Nodes& nodes() const { return model_->nodes; }
  fem::Model& model() { return *model_; }
  const fem::Model& model() const { return *model_; }
  fem::Motion& motion() { return motion_; }
  const fem::Motion& motion() const { return motion_; }
  const fem::Material& material() const { return material_; }

  std::vector<Vec3> internalForce;     ///< N, of the last FEM evaluation (gravity included)
  std::vector<Vec3> acceleration;      ///< m/s², of the forces that act at every step
  std::vector<Vec3> slowAcceleration;  ///< m/s², of those that act at the ends of a window of several steps
  double strainEnergy = 0.0;           ///< J, if asked for
  double splittingEnergy = 0.0;        ///< J, if asked for: see stepExplicit

private:
  std::unique_ptr<fem::Model> model_;
  fem::Motion motion_;
  fem::Material material_;
};

/// The state of a coupling. Arrays over the rows of `gap`.
struct Coupling {
  CouplingOptions options;
  Overlap overlap;
  GapOperator gap;
  std::unique_ptr<Constraint> constraint;
  std::unique_ptr<Absorber> absorber;  ///< absent = nothing is absorbed

  std::vector<Vec3> gapNow;                ///< accumulated since the start, m
  std::vector<Vec3> increment;             ///< of the last step, m
  std::vector<Vec3> lambda, lambdaBefore;  ///< N, of the last two evaluations
  std::vector<Vec3> nodeForce;             ///< Bᵀλ of all nodes, N
  std::vector<double> fullMass;            ///< of all particles, kg

  double storedEnergy() const;
  std::size_t rows() const { return gap.rows(); }
};

/// Weighs the masses of the particles, their contacts (pairs must be made) and sets up projection and constraint.
/// The solid must have been made with 1 − nodalWeight.
/// @param particles  with full masses; weighted on return
/// @throws InputError as the parts do, or if the overlap is narrower than an element
Coupling makeCoupling(dem::Particles& particles, dem::PairList& pairs, const Solid& solid,
                      std::span<const double> nodalWeight, const CouplingOptions& options);

/// What a renewal changed, to be booked.
struct Handover {
  double energy = 0.0;  ///< J: kinetic (of the particles) and coupling energy that left with the change of weights
  Vec3 momentum;        ///< kg m/s, that left with it
};

/// Locates the particles anew and renews weights, projection and constraint; the accumulated gap is kept by node, so
/// that λ does not jump. Call it when particles have moved relative to the mesh.
/// Contact energy changes with the factors of the pairs; the caller books the difference of its sum.
/// @throws InputError for rows per element
Handover renew(Coupling& coupling, dem::Particles& particles, dem::PairList& pairs, const Solid& solid);

}  // namespace dovetail::arlequin
