// Bricks: internal forces, energy, mass and tangent.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/laws/materials.hpp"
#include "dovetail/fem/mesh/mesh.hpp"
#include "dovetail/fem/model/nodes.hpp"
#include "dovetail/fem/solve/sparse.hpp"

namespace dovetail::fem {

enum class ElementType {
  /// Trilinear displacement, 2×2×2 Gauss points, total Lagrangian. Too stiff in bending by shear locking (1 + 1/(2n²)
  /// for n cubes through the depth and ν = 0), and locks as ν → ½.
  hex8,
  /// Trilinear displacement and an assumed stress with 18 parameters (Pian & Tong 1986) after Hellinger and Reissner,
  /// on Green's strain: exact in bending for rectangular bricks, does not lock as ν → ½, 18 = 24 − 6 modes with
  /// stiffness. StVenantKirchhoff only.
  hybrid8
};

namespace detail {
struct ElementCache;
}

/// Elements of one type and material: their numbering and the caches that the functions below use. Copies share the
/// cache; use one copy from one thread at a time (the loops inside are parallel).
class ElementBlock {
public:
  ElementBlock(ElementType type, const Material& material, std::shared_ptr<detail::ElementCache> cache)
      : type_(type), material_(material), cache_(std::move(cache)) {}
  ElementType type() const { return type_; }
  const Material& material() const { return material_; }
  std::size_t size() const;
  std::size_t nodeCount() const;
  std::span<const std::array<int, 8>> elements() const;
  /// Reference positions of the nodes, m.
  std::span<const Vec3> X() const;
  /// Weight of the integrand at the nodes; empty = 1 throughout.
  std::span<const double> nodalWeight() const;
  /// Elements that use the faster kernel for boxes along the axes.
  std::size_t boxes() const;
  detail::ElementCache& cache() const { return *cache_; }

private:
  ElementType type_;
  Material material_;
  std::shared_ptr<detail::ElementCache> cache_;
};

/// @param nodalWeight  per node, 0 … 1, interpolated to the Gauss points: every integral below (energy, force, mass,
///        tangent) is weighted by it, as the solid's share of an overlap is. Empty = 1 throughout.
/// @throws InputError for an invalid mesh or material, weights that are not one per node or not within 0 … 1, or
/// hybrid8
///         with another law than StVenantKirchhoff
ElementBlock makeElements(const Mesh& mesh, ElementType type, const Material& material,
                          std::span<const double> nodalWeight = {});

/// f −= ∂U/∂u (for DeformedMetricHooke: f −= ∫ δEᵀS). Bitwise the same for any number of threads.
/// @return the strain energy, J, if `withEnergy`, else 0
/// @throws InputError if the nodes are not those of the mesh
double addInternalForces(const ElementBlock& block, Nodes& nodes, bool withEnergy = false);

/// Strain energy, J.
double strainEnergy(const ElementBlock& block, const Nodes& nodes);
/// Strain energy of each element, J.
std::vector<double> elementEnergies(const ElementBlock& block, const Nodes& nodes);

/// @param when  for the message, for instance "t = 0.5 s, step 100"
/// @throws NumericalError naming the first element with det F ≤ 0 (or NaN) at a Gauss point
void requireValid(const ElementBlock& block, const Nodes& nodes, const std::string& when);

/// mass += ∫ρ ψ_i dV (row sums of the consistent mass).
void addLumpedMass(const ElementBlock& block, Nodes& nodes);
/// ∫ρ ψ_i ψ_j dV for each component; 3 × 3 identity blocks.
SparseMatrix consistentMass(const ElementBlock& block);

/// ∂(∂U/∂u)/∂u at the present displacement, N/m. Symmetric for StVenantKirchhoff.
SparseMatrix tangent(const ElementBlock& block, const Nodes& nodes);

/// Row-major 24 × 24 tangent of one element, rows 3a + c for its node a, N/m.
std::array<double, 576> elementTangent(const ElementBlock& block, const Nodes& nodes, std::size_t element);
/// The same from the displacements of all nodes, m.
std::array<double, 576> elementTangent(const ElementBlock& block, std::span<const Vec3> displacement,
                                       std::size_t element);

}  // namespace dovetail::fem
