// Tables of figures, and their summary.
#pragma once

#include <iosfwd>
#include <vector>

#include "measure.hpp"
#include "studies.hpp"

namespace dovetail::dem_benchmark {

struct Table {
  std::ostream& out;
  std::vector<Figures> rows;
  void header() const;
  const Figures& add(Figures figures);
};

void writeSummary(const Settings& settings, const std::vector<Figures>& rows, double triad);

}  // namespace dovetail::dem_benchmark
