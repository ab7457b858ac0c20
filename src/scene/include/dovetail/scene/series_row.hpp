// The row of a run's series at any instant.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// Columns are those of the run at its start, of what grains may book later, and of probes: to be made before the run
/// goes on, from a checkpoint too.
class SeriesRow {
public:
  /// @throws InputError for a probe of what is not there
  SeriesRow(const Built& built, const Scene& scene);
  ~SeriesRow();
  SeriesRow(SeriesRow&&) noexcept;
  SeriesRow& operator=(SeriesRow&&) noexcept;

  /// With their units: all, and those of the probes, which are the last.
  const std::vector<std::string>& names() const;
  const std::vector<std::string>& probeNames() const;
  /// Values as they are now. @param limit  of the step, s
  std::vector<double> now(const Built& built, double limit) const;
  std::vector<double> probesNow(const Built& built) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::scene
