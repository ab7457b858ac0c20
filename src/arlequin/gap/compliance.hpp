// What forces on the rows of a gap do to its acceleration.
#pragma once

#include <span>
#include <vector>

#include "dovetail/arlequin/gap_operator.hpp"
#include "dovetail/fem/model/model_mass.hpp"

namespace dovetail::arlequin {

/// A = Π M_DE⁻¹ Πᵀ + B M_FE⁻¹ Bᵀ as a product with vectors; time and memory grow with the entries of Π and B.
class Compliance {
public:
  /// @param particleMass  of all particles, weighted, kg; ∞ for one that does not yield
  /// @param solid         must live as long as this
  Compliance(const GapOperator& gap, const Overlap& overlap, std::span<const double> particleMass,
             const fem::ModelMass& solid);
  void apply(std::span<const Vec3> in, std::span<Vec3> out) const;
  /// M_DE⁻¹, 1/kg, one per row of the overlap.
  std::span<const double> yield() const { return yield_; }

private:
  void moveNodes(std::span<const Vec3> in) const;

  const fem::ModelMass& solid_;
  cg::Projection particles_, particlesBack_;
  cg::Projection nodes_, nodesBack_;  // nodes: by their place among those coupled
  std::vector<int> coupledNode_;
  std::vector<double> yield_;
  std::vector<Vec3> nodeYield_;  // 1/kg, 0 where held; of lumped masses without ties
  mutable std::vector<Vec3> ofParticles_, ofNodes_, allNodes_;
};

/// B on the nodes that are free, with lumped masses: nodes that are tied count as parts of their masters.
struct LumpedNodes {
  cg::Projection map, back;
  std::vector<double> yield;  ///< 1/kg, one per node
  bool operator==(const LumpedNodes& other) const {
    return map.column == other.map.column && map.weight == other.map.weight && yield == other.yield;
  }
};
LumpedNodes lumpedNodes(const GapOperator& gap, const fem::ModelMass& solid, int component);

}  // namespace dovetail::arlequin
