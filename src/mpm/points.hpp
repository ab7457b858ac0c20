// Material points as a term of a model.
#pragma once

#include <array>

#include "anchors.hpp"
#include "dovetail/mpm/point_solid.hpp"
#include "transfer.hpp"

namespace dovetail::mpm::detail {

class Points final : public PointSolid {
public:
  Points(const MaterialPoints& points, std::shared_ptr<fem::PointField> field, const PointOptions& options);

  std::string name() const override { return options_.name; }
  bool usesVelocity() const override { return false; }
  /// Borders push.
  bool actsWithin() const override { return options_.grid.borders.empty(); }
  bool isBody() const override { return true; }
  bool isSymmetric() const override { return answers_.field().isSymmetric(); }
  bool feelsRates() const override { return answers_.field().feelsRates(); }
  bool hasEnergy() const override { return answers_.field().hasEnergy(); }

  std::vector<Vec3> places(const fem::Nodes& nodes) const override;
  const GridRows& rows() const override { return rows_; }
  const GridOptions& grid() const override { return options_.grid; }
  const std::vector<double>& laidDeformation() const override { return F0_; }
  const std::vector<double>& masses() const override { return carried_.mass; }
  const fem::FieldAnswers& answers() const override { return answers_; }
  double beyondNodes() const override { return beyond_; }
  std::int64_t renewals() const override { return renewals_; }
  std::size_t memory() const override;
  std::size_t addMarkers(std::span<const Vec3> x) override;
  const Markers& markers(std::size_t set) const override;

  void addForces(const fem::Nodes& nodes, const fem::Instant& now, std::span<Vec3> f) override;
  double addForcesAndEnergy(const fem::Nodes& nodes, const fem::Instant& now, std::span<Vec3> f) override;
  double energy(const fem::Nodes& nodes, const fem::Instant& now) override;
  void addPattern(linalg::MatrixPattern& pattern) const override;
  void addTangent(const fem::Nodes& nodes, const fem::Instant& now, linalg::BlockMatrix& K) override;
  void addStiffness(const fem::Nodes&, const fem::Instant&, std::span<double>) override {}
  std::optional<fem::StableStep> stableStep(const fem::Nodes& nodes) override;

  double commit(const fem::Nodes& nodes, const fem::Instant& now) override;
  void revert() override { answers_.revert(); }
  bool wantsOtherNodes(const fem::Nodes& nodes) const override;
  double renewNodes(fem::Nodes& nodes, double t) override;
  void addMass(std::span<double> mass) const override;
  void addConsistentMass(linalg::NodeMatrix&) const override;
  void requireValid(const fem::Nodes& nodes, const std::string& when, fem::Scrutiny scrutiny) override;

  bool ownsNodes() const override { return true; }
  void layNodes(fem::Nodes& nodes) override;
  void save(ByteWriter& archive) const override;
  void load(ByteReader& archive) override;

private:
  /// A set of markers.
  struct Marked {
    Anchors anchors;
    Markers markers;
  };

  void ask(const fem::Nodes& nodes, const fem::Instant& now, fem::Wanted wanted);
  void findDeformation(std::span<const Vec3> u);
  void addAnswers(std::span<Vec3> f) const;
  double volumeSum(std::span<const double> perVolume) const;
  double stored() const;
  std::array<double, 81> moduli(std::size_t p) const;
  void requireSameNodes(const fem::Nodes& nodes) const;

  PointOptions options_;
  fem::FieldAnswers answers_;
  Carried carried_;  // as when the grid was laid out
  std::vector<double> volume_, F0_;
  GridRows rows_;
  std::vector<Vec3> v0_;  // of nodes, m/s
  std::vector<Marked> marked_;
  double beyond_ = 0.0, laidAt_ = 0.0;
  std::int64_t renewals_ = 0;
  bool isNew_ = false;  // nothing was asked since the grid was laid out under points that had answered
};

}  // namespace dovetail::mpm::detail
