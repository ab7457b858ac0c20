// What all formulations share: batches of four elements, their geometry, history, threads and assembly.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "elements/lanes/lane.hpp"
#include "solid_cells.hpp"
#include "solid_points.hpp"

namespace dovetail::fem::detail {

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
  bool rateAtEnd = false;  ///< as in Instant
};

/// Who adds to which node where chunks of batches are computed at the same time: a node belongs to the first chunk that
/// meets it. What later chunks have for it waits, and is added in their order.
struct SharedNodes {
  std::vector<std::int32_t> owner;            ///< chunk, per node of the mesh
  std::vector<std::uint32_t> first;           ///< per chunk, place in `late` of its first entry
  std::vector<Vec3> late;                     ///< N, in the order of the elements
  std::vector<int> node;                      ///< that late entries are for
  std::vector<std::uint32_t> offsets, place;  ///< of its entries, ascending
  std::size_t memory() const;
};

/// Of numbers in a state: [groups batch + g][lane][record], in a vector of their own. Lanes that repeat an element
/// repeat its numbers.
struct StateShape {
  std::size_t groups, record;
};

class SolidBase : public Solid {
public:
  /// @param lazy  leave geometry_ empty until needGeometry()
  SolidBase(SolidCells cells, std::unique_ptr<SolidPoints> points, const SolidOptions& options, bool lazy = false);
  ~SolidBase() override;

  std::string name() const override { return options_.name; }
  bool usesVelocity() const override { return false; }
  bool feelsRates() const override { return points_->feelsRates(); }
  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override;
  double addForcesAndEnergy(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override;
  void addPattern(linalg::MatrixPattern& pattern) const override;
  void addTangent(const Nodes& nodes, const Instant& now, linalg::BlockMatrix& K) override;
  bool addConservingForces(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                           std::span<Vec3> f) override;
  void addConservingTangent(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                            linalg::BlockMatrix& K) override;
  bool isSymmetric() const override { return points_->isSymmetric(); }
  bool hasEnergy() const override { return points_->hasEnergy(); }
  double energy(const Nodes& nodes, const Instant& now) override;
  double commit(const Nodes& nodes, const Instant& now) override;
  void revert() override { points_->revert(); }
  void addMass(std::span<double> mass) const override;
  void addBodyMass(std::span<double> mass) const override;
  void addConsistentMass(linalg::NodeMatrix& M) const override;
  void save(ByteWriter& archive) const override { points_->save(archive); }
  void load(ByteReader& archive) override;
  /// The vectors that save() writes for a material.
  virtual std::vector<StateShape> stateShapes() const { return {{pointCount(), points_->law()->historySize()}}; }
  void requireValid(const Nodes& nodes, const std::string& when, Scrutiny scrutiny) override;

  std::size_t size() const override { return cells_.size(); }
  std::size_t memory() const override;
  const PointMaterial* material() const override { return points_->law(); }
  const PointField* field() const override { return points_->field() ? &points_->field()->answers.field() : nullptr; }
  double density() const override { return points_->density(); }
  std::optional<StableStep> stableStep(const Nodes& nodes) override;
  ElementShape shape() const override { return cells_.shape; }
  Formulation formulation() const override { return options_.formulation; }
  int number(std::size_t e) const override { return cells_.number[e]; }
  Sample sample(const Nodes& nodes, const Instant& now) override;
  std::vector<double> elementEnergies(const Nodes& nodes, const Instant& now) override;
  std::span<const double> fraction() const override { return cells_.fraction; }

protected:
  virtual std::size_t pointCount() const { return static_cast<std::size_t>(rule_->points); }
  /// Forces and, if wanted, energy and dissipation of a batch.
  virtual void forces(const BatchTask& task, BatchResult& result) = 0;
  /// Tangent of a batch, [(3 nodes)(3a + i) + 3b + k], N/m.
  virtual void tangent(const BatchTask& task, Lane* K) = 0;
  /// F at the points of a batch, [9 q + 3i + J].
  virtual void deformation(const BatchTask& task, Lane* F) const = 0;
  /// The same without what the formulation replaces: what tells whether an element is inverted.
  virtual void compatibleDeformation(const BatchTask& task, Lane* F) const { deformation(task, F); }
  /// Asks the points of a batch whose F is given; any of tangent, energy, dissipated may be null.
  void evaluate(const BatchTask& task, const Lane* F, Lane* P, Lane* tangent, Lane* energy, Lane* dissipated);
  void requireSameNodes(const Nodes& nodes) const;
  /// Whether forces() and tangent() know what to do with a `start`.
  virtual bool conserves() const { return false; }

  /// Bytes of what a formulation keeps beside.
  virtual std::size_t formulationMemory() const { return 0; }
  /// What the hand-written kernels say of a batch.
  void forcesByKernels(const BatchTask& task, BatchResult& result) const;
  void needGeometry();
  /// Tells the points where they are; called on first use.
  void openPoints();
  /// From now on the hand-written kernels give forces and energies, and geometry() waits until something else needs it.
  void useKernels(const Material& law, bool assumedStress);

  SolidCells cells_;
  std::unique_ptr<SolidPoints> points_;
  SolidOptions options_;
  const CellRule* rule_;
  std::vector<PointGeometry> geometry_;       // empty where kernels do without
  std::unique_ptr<const BrickCache> bricks_;  // if there are kernels

private:
  struct Totals {
    double energy = 0.0, dissipated = 0.0;
    Totals& operator+=(const Totals& other) {
      energy += other.energy;
      dissipated += other.dissipated;
      return *this;
    }
  };
  /// What the last evaluation of points that remember was asked, and answered.
  struct Evaluation {
    std::vector<Vec3> u;
    double dt = 0.0;
    bool rateAtEnd = false;
    Totals totals;
    bool known = false, hasEnergy = false, committed = false;
  };

  BatchTask taskOf(std::size_t batch, const Nodes& nodes, const Instant& now, const Vec3* start = nullptr) const;
  template <class Body>
  Totals eachBatch(std::span<Vec3> f, Body&& body);
  Totals addAll(const Nodes& nodes, const Instant& now, const Vec3* start, std::span<Vec3> f, bool withEnergy);
  /// The conserving forces of a formulation whose forces() knows nothing of a `start`.
  void balancedForces(const BatchTask& task, BatchResult& result);
  void setPath(std::span<const Vec3> u0, std::span<const Vec3> u1);
  std::size_t slot(std::size_t a, std::size_t i) const;
  template <std::size_t across, class Slot, class Sink>
  void handOut(std::size_t batch, const Lane* forces, Slot&& slotOf, Sink&& sink) const;
  template <class Sink>
  void handOut(std::size_t batch, const Lane* forces, Sink&& sink) const;
  std::size_t chunkSize() const;
  void energies(const BatchTask& task, BatchResult& result);
  bool isKnown(const Nodes& nodes, const Instant& now) const;
  Totals totals(const Nodes& nodes, const Instant& now, bool withEnergy);
  void ask(const Nodes& nodes, const Instant& now, const Wanted& wanted = {});
  template <class Visit>
  void eachPoint(Visit&& visit) const;
  [[noreturn]] void complain(std::size_t batch, std::size_t lane, const std::string& reason,
                             const std::string& when) const;
  void requireUpright(std::size_t batch, const Nodes& nodes, const std::string& when) const;

  void assemble(const Nodes& nodes, const Instant& now, const Vec3* start, double fraction, linalg::BlockMatrix& K);
  void shareNodes();
  void colourBatches();
  void findPlaces(const linalg::BlockMatrix& K);
  void scatter(std::size_t batch, const Lane* matrix, double fraction, linalg::BlockMatrix& K) const;

  Evaluation evaluation_;
  std::array<std::vector<Vec3>, 3> path_;  // displacements at the Gauss points of the path of a conserving step
  SharedNodes shared_;                     // for more than one thread
  std::vector<std::vector<std::uint32_t>> colours_;  // batches of a colour share no node
  std::vector<std::uint32_t> places_;                // of the blocks (a, b) of each element in a matrix
  std::size_t placesOf_ = 0;                         // its pattern
};

std::shared_ptr<Solid> makeStandardSolid(SolidCells, std::unique_ptr<SolidPoints>, const SolidOptions&);
std::shared_ptr<Solid> makeAssumedStressSolid(SolidCells, std::unique_ptr<SolidPoints>, const SolidOptions&);
std::shared_ptr<Solid> makeMeanDilatationSolid(SolidCells, std::unique_ptr<SolidPoints>, const SolidOptions&);
std::shared_ptr<Solid> makeEnhancedSolid(SolidCells, std::unique_ptr<SolidPoints>, const SolidOptions&);
std::shared_ptr<Solid> makeReducedSolid(SolidCells, std::unique_ptr<SolidPoints>, const SolidOptions&);

}  // namespace dovetail::fem::detail
