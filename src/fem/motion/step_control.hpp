// Explicit steps that follow the solid.
#pragma once

#include <cstdint>
#include <string>

#include "dovetail/core/archive.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"

namespace dovetail::fem::detail {

/// Sets the length of explicit steps: always the same, or a fraction of the bound of the stiffest element, which is
/// looked at more often the faster it changes.
class StepControl {
public:
  /// @param dt  the longest step, s
  /// @throws InputError for a step or options out of range, or above the bound (options.checkStep)
  StepControl(Model& model, double dt, const ExplicitOptions& options);

  double dt() const { return dt_; }
  /// The bound when it was last looked at, s; 0 if it was not.
  double critical() const { return critical_; }
  const StepRange& range() const { return range_; }

  /// A step has been accepted. @throws NumericalError naming the element, if the next would be below the shortest
  void accept(Model& model);

  void save(ByteWriter& archive) const;
  /// What save() wrote, for the same options. @throws InputError if it is damaged
  StepControl read(ByteReader& archive) const;

private:
  bool follows() const { return options_.safety > 0.0; }
  StableStep look(Model& model);
  void follow(Model& model);

  ExplicitOptions options_;
  double longest_, dt_, first_ = 0.0, critical_ = 0.0;
  StepRange range_;
  std::int64_t interval_ = 1, wait_ = 1;  // steps from look to look, and to the next one
};

}  // namespace dovetail::fem::detail
