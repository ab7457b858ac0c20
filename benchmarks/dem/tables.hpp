// Tables of figures, and their summary.
#pragma once

#include <iosfwd>
#include <vector>

#include "dovetail/report/table.hpp"
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
/// The name of the study, the content and where it comes from, as JSON, if a summary is asked for.
void writeSummary(const Settings& settings, const report::Json& content);

}  // namespace dovetail::dem_benchmark
