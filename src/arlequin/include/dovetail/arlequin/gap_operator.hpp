// What is compared: the gap between particles and solid at the coarse nodes of the overlap, as one linear map.
#pragma once

#include <span>
#include <vector>

#include "dovetail/arlequin/cells.hpp"
#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/cg/kernel.hpp"
#include "dovetail/cg/projection.hpp"

namespace dovetail::arlequin {

enum class GapForm {
  /// g = Π (v_DE − Φ v_FE): the solid's field is taken at the particles. Linear fields make no gap, for any Π whose
  /// rows sum to one; forces and moments balance.
  atParticles,
  /// g = Π v_DE − v_FE (Cheng et al. 2023, Eqs. 27 and 32): Π x_α is not X_i at one-sided nodes, so rotation and strain
  /// make a false gap there.
  nodal
};

struct ProjectionOptions {
  double width = 0.0;  ///< c, m; 0 = local, Π_iα ∝ m_α ψ_i(x_α)
  cg::KernelShape kernel = cg::KernelShape::lucy;
  /// Whether each particle's kernel is normalised over the overlap: the part that would reach beyond a border is then
  /// not lost, and an even load on the nodes is an even load on the particles. The paper's Eq. 27 does without.
  bool normaliseKernels = true;
  /// One row per element and corner, from the particles of that element alone (with a kernel: from its part of the
  /// integral), in place of one per node. Every element then is one-sided at all its nodes.
  bool perElement = false;
  /// Whether kernels also reach the elements without a particle in which w falls to 0, and particles outside of the
  /// mesh that the overlap was located with. For the nodal form.
  bool reachOut = false;
  /// Kernels are integrated over elements cut into kernelCells³ parts of 2×2×2 Gauss points; 0 = as many as they need.
  int kernelCells = 0;
};

/// The gap at row i is Σ Π_ik v(overlap particle k) − Σ B_in v(node n); λ_i (N) pulls the particles back by −Πᵀλ and
/// the nodes along by Bᵀλ: the adjoint, so that the power lost by one side is gained by the other, up to what the gap
/// does.
struct GapOperator {
  std::vector<int> node;  ///< coarse node of each row; ascending unless the rows are per element
  std::vector<Vec3> X;    ///< of these nodes, m
  std::vector<double>
      volume;  ///< ∫ψ_i dV over the overlap's elements, m³; ψ: the vertex shape functions of the corners, throughout
  cg::Projection particles;       ///< Π; columns are the rows of Overlap
  cg::Projection nodes;           ///< B = ΠΦ, or the identity on the rows' nodes; columns are nodes
  cg::Projection particlesBack;   ///< Πᵀ, by particles
  cg::Projection nodesBack;       ///< Bᵀ, by coupled nodes
  std::vector<int> coupledNode;   ///< nodes that B touches, ascending: the rows of nodesBack
  cg::Projection volumeProducts;  ///< ∫ψ_i ψ_j dV over the overlap's elements, m³; rows and columns are gap rows

  std::size_t rows() const { return node.size(); }
};

/// Whether GapOperator::volume and volumeProducts are wanted, which take as long as the rest.
enum class RowVolumes { leftOut, integrated };

/// Π for c = 0: Π_iα = m_α ψ_i(x_α) / Σ; for c > 0: ∫ m_α W(x − x_α) ψ_i dx / Σ over the overlap's elements (Eq. 27),
/// by Gauss points as fine as the kernel asks for, normalised by the quadrature itself. Rows with no particle, or with
/// less than a thousandth of the mean, are left out. Φ takes the solid's field with all shape functions.
/// @param mass  full masses of all particles, kg
/// @param mesh  reference configuration: volumes are counted there
/// @param position  of the nodes when the overlap was located, for kernels, m; empty = mesh.X
/// @throws InputError for a width that is negative or not finite
GapOperator makeGapOperator(const Overlap& overlap, const fem::SolidMesh& mesh, std::span<const double> mass,
                            GapForm form, const ProjectionOptions& options, std::span<const Vec3> position = {},
                            RowVolumes volumes = RowVolumes::integrated);

/// Σ_α value_α ψ_i(x_α) per row, over the particles within the mesh; for rows per node.
/// @param value  one per row of the overlap
std::vector<double> sumsAtRows(const GapOperator& gap, const Overlap& overlap, const fem::SolidMesh& mesh,
                               std::span<const double> value);

/// out_i = Π v_particles − B v_nodes per row.
/// @param particles  values of all particles   @param nodes  values of all nodes
void gapOf(const GapOperator& gap, const Overlap& overlap, std::span<const Vec3> particles, std::span<const Vec3> nodes,
           std::span<Vec3> out);
/// The same from values of the overlap's particles, one per row of the overlap.
void gapOfMembers(const GapOperator& gap, std::span<const Vec3> members, std::span<const Vec3> nodes,
                  std::span<Vec3> out);
/// particleForce −= Πᵀλ (all particles).
void pullParticles(const GapOperator& gap, const Overlap& overlap, std::span<const Vec3> lambda,
                   std::span<Vec3> particleForce);
/// nodeForce += Bᵀλ (all nodes).
void pullNodes(const GapOperator& gap, std::span<const Vec3> lambda, std::span<Vec3> nodeForce);

}  // namespace dovetail::arlequin
