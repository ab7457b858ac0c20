// What holds a solid in a state out of balance until load steps release it.
#pragma once

#include <string>
#include <vector>

#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem {

/// A force −s R on the nodes: R is out of balance in the state that is held, on the components that constraints leave
/// free, so that s = 1 is in equilibrium there, and s = 0 under the model's own loads. Its work is the
/// trapezoidal sum over commits; reports do not count it among that of loads.
class HeldLoad final : public Term {
public:
  std::string name() const override { return "held load"; }
  bool usesVelocity() const override { return false; }

  /// Holds the model as it is, prescribed components in their place at model.t: s = 1, no work so far. The term may not
  /// be among those of the model.
  void hold(Model& model);
  /// s goes from `before` at time `from` to `after` at time `to`, s, and stays; at once if the times are equal.
  void release(double before, double after, double from, double to);
  bool holds() const { return !force_.empty(); }
  /// Whether R is zero.
  bool isIdle() const;
  void end() { *this = {}; }
  /// s at a time, s.
  double factor(double t) const;
  /// On the nodes since hold(), J: below 0 where it holds back what the loads would do.
  double work() const { return work_; }

  bool hasEnergy() const override { return true; }
  double energy(const Nodes& nodes, const Instant& now) override;
  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override;
  double commit(const Nodes& nodes, const Instant& now) override;
  void save(ByteWriter& archive) const override;
  void load(ByteReader& archive) override;

private:
  std::vector<Vec3> force_, last_;  // R, N; u at the last commit, m
  double before_ = 1.0, after_ = 1.0, from_ = 0.0, to_ = 0.0;
  double lastFactor_ = 1.0, work_ = 0.0;
};

}  // namespace dovetail::fem
