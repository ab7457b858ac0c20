// What all formulations share: batches of four elements, their geometry, history, threads and assembly.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "../mesh/shapes.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/solve/block_matrix.hpp"
#include "lane.hpp"

namespace dovetail::fem::detail {

/// The elements of one shape that a solid consists of, four side by side. A batch that is not full repeats its last
/// element with zero weight.
struct SolidCells {
  CellShape shape;
  std::size_t nodes;                                           ///< per element
  std::vector<int> node;                                       ///< [nodes e + a]
  std::vector<int> number;                                     ///< in the mesh, per element
  std::vector<Vec3> X;                                         ///< of the mesh, m
  std::vector<std::array<std::int32_t, laneCount>> batchNode;  ///< [nodes b + a]
  std::size_t size() const { return number.size(); }
  std::size_t batches() const { return (size() + laneCount - 1) / laneCount; }
  std::size_t inUse(std::size_t batch) const { return std::min<std::size_t>(laneCount, size() - laneCount * batch); }
};

/// ∂ξ/∂X, row-major, and weight (det ∂X/∂ξ times that of the rule; 0 in lanes that repeat) at one point of a batch.
struct alignas(laneBytes) PointGeometry {
  std::array<Lane, 9> map;
  Lane weight;
};

/// Geometry at every point of a rule, [points b + q].
std::vector<PointGeometry> geometryAt(const SolidCells& cells, const CellRule& rule);

/// Sums over the points of a batch.
struct alignas(laneBytes) BatchResult {
  std::array<Lane, 3 * maxCellNodes> f;  ///< ∂U/∂u, [3 a + i], N
  Lane energy, dissipated;               ///< J
};

/// What a formulation computes for a batch.
struct BatchTask {
  std::size_t batch;
  const Vec3* u;
  const Vec3* start;  ///< displacement at the start of the step for the conserving forces, else null
  double dt;
  bool wantEnergy, wantDissipation;
};

class SolidBase : public Solid {
public:
  SolidBase(SolidCells cells, std::shared_ptr<const PointMaterial> material, const SolidOptions& options);

  std::string name() const override { return options_.name; }
  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override;
  void addCouplings(Couplings& couplings) const override;
  void addTangent(const Nodes& nodes, const Instant& now, BlockMatrix& K) override;
  bool addConservingForces(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                           std::span<Vec3> f) override;
  void addConservingTangent(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now, BlockMatrix& K) override;
  bool isSymmetric() const override { return material_->isSymmetric(); }
  /// A law without potential has no history either that would book what its work leaves.
  bool hasEnergy() const override { return material_->isElastic() || material_->historySize() > 0; }
  double energy(const Nodes& nodes, const Instant& now) override;
  double commit(const Nodes& nodes, const Instant& now) override;
  void addMass(std::span<double> mass) const override;
  void addBodyMass(std::span<double> mass) const override;
  void addConsistentMass(BlockMatrix& M) const override;
  void save(ByteWriter& archive) const override { archive(history_); }
  void load(ByteReader& archive) override;
  void requireValid(const Nodes& nodes, const std::string& when) const override;

  std::size_t size() const override { return cells_.size(); }
  std::size_t memory() const override;
  const PointMaterial& material() const override { return *material_; }
  StableStep stableStep(const Nodes& nodes) override;
  int number(std::size_t e) const override { return cells_.number[e]; }
  Sample sample(const Nodes& nodes, const Instant& now) override;

protected:
  virtual std::size_t points() const { return static_cast<std::size_t>(rule_->points); }
  /// Forces and, if wanted, energy and dissipation of a batch.
  virtual void forces(const BatchTask& task, BatchResult& result) = 0;
  /// Tangent of a batch, [(3 nodes)(3a + i) + 3b + k], N/m.
  virtual void tangent(const BatchTask& task, Lane* K) = 0;
  /// F at the points of a batch, [9 q + 3i + J].
  virtual void deformation(const BatchTask& task, Lane* F) const = 0;
  /// The same without what the formulation replaces: what tells whether an element is inverted.
  virtual void compatibleDeformation(const BatchTask& task, Lane* F) const { deformation(task, F); }
  /// Calls the material for a batch whose F is given; any of tangent, energy, dissipated may be null.
  void evaluate(const BatchTask& task, const Lane* F, Lane* P, Lane* tangent, Lane* energy, Lane* dissipated);
  void requireSameNodes(const Nodes& nodes) const;
  /// @throws InputError unless there are so many, all finite
  std::vector<double> readNumbers(ByteReader& archive, std::size_t count) const;
  /// Whether forces() and tangent() know what to do with a `start`.
  virtual bool conserves() const { return false; }

  SolidCells cells_;
  std::shared_ptr<const PointMaterial> material_;
  SolidOptions options_;
  const CellRule* rule_;
  std::vector<PointGeometry> geometry_;

private:
  /// Whether row sums of the consistent mass, negative at corners, cannot be lumped masses.
  bool scalesDiagonal() const { return cells_.shape == CellShape::hex20 || cells_.shape == CellShape::tet10; }
  std::vector<double> elementMasses(std::size_t element, const CellRule& rule, std::span<const PointGeometry> geometry,
                                    bool scaled) const;
  void addMasses(std::span<double> mass, bool scaled) const;
  BatchTask taskOf(std::size_t batch, const Nodes& nodes, const Instant& now, const Vec3* start = nullptr) const;
  void addAll(const Nodes& nodes, const Instant& now, const Vec3* start, std::span<Vec3> f);
  void assemble(const Nodes& nodes, const Instant& now, const Vec3* start, double share, BlockMatrix& K);
  /// The conserving forces of a formulation whose forces() knows nothing of a `start`.
  void balancedForces(const BatchTask& task, BatchResult& result);
  void setPath(std::span<const Vec3> u0, std::span<const Vec3> u1);
  std::array<double, 2> totals(const Nodes& nodes, const Instant& now, bool wantEnergy, bool wantDissipation);
  void startHistory();
  void listEntries();
  void colourBatches();
  void findPlaces(const BlockMatrix& K);
  void scatter(std::size_t batch, const Lane* matrix, double share, BlockMatrix& K) const;

  std::vector<double> history_, newHistory_;
  std::array<std::vector<Vec3>, 3> path_;   // displacements at the Gauss points of the path of a conserving step
  LaneVector results_;                      // forces of all batches, [3 nodes b + 3 a + i], for more than one thread
  std::vector<std::uint32_t> nodeOffsets_;  // entries of each node in results_, ascending elements
  std::vector<std::uint64_t> nodeEntries_;  // place of their first component, in doubles
  std::vector<std::vector<std::uint32_t>> colours_;  // batches of a colour share no node
  std::vector<std::uint32_t> places_;                // of the blocks (a, b) of each element in a matrix
  std::size_t placesOf_ = 0;                         // its pattern
};

std::shared_ptr<Solid> makeStandardSolid(SolidCells, std::shared_ptr<const PointMaterial>, const SolidOptions&);
std::shared_ptr<Solid> makeAssumedStressSolid(SolidCells, std::shared_ptr<const PointMaterial>, const SolidOptions&);
std::shared_ptr<Solid> makeMeanDilatationSolid(SolidCells, std::shared_ptr<const PointMaterial>, const SolidOptions&);
std::shared_ptr<Solid> makeEnhancedSolid(SolidCells, std::shared_ptr<const PointMaterial>, const SolidOptions&);
std::shared_ptr<Solid> makeReducedSolid(SolidCells, std::shared_ptr<const PointMaterial>, const SolidOptions&);

}  // namespace dovetail::fem::detail
