// Values at a point of a solid.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/mesh/element_locator.hpp"

namespace dovetail::fem {

/// A point that moves with the solid.
class MaterialPoint {
public:
  /// @param X  reference position, m
  /// @throws InputError if no element is there
  MaterialPoint(const SolidMesh& mesh, const Vec3& X);
  /// The same for many points. @param locator  of the mesh in its reference configuration
  MaterialPoint(const SolidMesh& mesh, const ElementLocator& locator, const Vec3& X);

  /// Number in the mesh of the element that holds it; of several, the first.
  int element() const { return element_; }
  /// Σ N_a field_a: its displacement of nodes.u, its velocity of nodes.v.
  Vec3 valueOf(std::span<const Vec3> field) const;
  /// Cauchy stress, Pa, row-major: the function of the element's parent coordinates, trilinear in bricks, bilinear in
  /// plane cells and linear in tetrahedra, that comes nearest to the stresses at its quadrature points; their mean
  /// where they are too few for it.
  /// @throws InputError if the sample is of a solid without this element
  std::array<double, 9> stress(const Solid::Sample& sample) const;

private:
  int element_ = -1;
  ElementShape shape_{};
  Vec3 xi_;  // in the parent cell
  std::vector<int> node_;
  std::vector<Vec3> X_;  // of the nodes, m
  std::vector<double> N_;
};

}  // namespace dovetail::fem
