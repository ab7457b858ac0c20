// A solid with everything that acts on it: nodes, terms, constraints.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/constraints.hpp"
#include "dovetail/fem/model/term.hpp"

namespace dovetail::fem {

/// The state and the terms. Integrators and solvers (statics.hpp, dynamics.hpp) work on it. It moves, but has no
/// copies: terms keep history (plastic strain, multipliers), which two models would share.
struct Model {
  Model() = default;
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  Model(Model&&) = default;
  Model& operator=(Model&&) = default;

  Nodes nodes;
  std::vector<std::shared_ptr<Term>> terms;
  Constraints constraints;
  double t = 0.0;  ///< s

  template <class T>
  T& add(std::shared_ptr<T> term) {
    T& reference = *term;
    terms.push_back(std::move(term));
    return reference;
  }
};

/// Nodes of the mesh at rest, without terms; component z is held in plane strain.
Model makeModel(const SolidMesh& mesh);
/// Sets nodes.mass and bodyMass from the terms. @throws InputError naming a node that no term gives a mass
void addMass(Model& model);

/// Whether a term lays out the nodes (a grid under material points): their number changes in a run then.
bool ownsNodes(const Model& model);

/// The groups of nodes that the terms couple. Where terms are shared by ranks, those of this rank's part and of the
/// other terms: of matrices that are sums over the ranks.
linalg::MatrixPattern patternOf(const Model& model);
/// A matrix with a block for every pair of nodes that a term couples; all zero.
linalg::BlockMatrix zeroTangent(const Model& model);
/// The matrix for what the term adds: of terms that are not shared, each rank takes the rows of its nodes.
template <class Matrix>
Matrix& rowsFor(const Term& term, Matrix& matrix) {
  matrix.addOwnRowsOnly(!term.isShared());
  return matrix;
}
/// K += tangents of all terms.
void addTangents(const Model& model, const Instant& now, linalg::BlockMatrix& K);

/// f = Σ forces of the terms at nodes.u, v.
void evaluateForces(Model& model, const Instant& now);
/// Σ energies of the terms that store one, J.
double storedEnergy(Model& model, const Instant& now);

}  // namespace dovetail::fem
