#include "tables.hpp"

#include <ostream>

#include "dovetail/report/summary.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::dem_benchmark {

using report::format;

void Table::header() const {
  out << format("%-34s %9s %6s %6s %9s %15s %7s %7s %7s %6s %6s\n", "scene", "particles", "pairs", "cont.", "M steps/s",
                "lowest-highest", "ns", "B held", "B moved", "builds", "prunes");
}

const Figures& Table::add(Figures f) {
  const auto n = static_cast<double>(f.particles);
  out << format("%-34s %9zu %6.2f %6.2f %9.2f %7.2f-%7.2f %7.1f %7.0f %7.0f %6lld %6lld\n", f.name.c_str(), f.particles,
                static_cast<double>(f.pairs) / n, static_cast<double>(f.contacts) / n, f.rates.median, f.rates.lowest,
                f.rates.highest, f.nanoseconds(), f.bytesHeld, f.bytesMoved, static_cast<long long>(f.builds),
                static_cast<long long>(f.prunings))
      << std::flush;
  rows.push_back(std::move(f));
  return rows.back();
}

void writeSummary(const Settings& s, const std::vector<Figures>& rows, double triad) {
  report::Json json{{"triad_GB_per_s", triad}};
  for (const Figures& f : rows)
    json["scenes"].push_back({{"name", f.name},
                              {"particles", f.particles},
                              {"million_steps_per_s", f.rates.median},
                              {"lowest", f.rates.lowest},
                              {"highest", f.rates.highest},
                              {"bytes_held_per_particle", f.bytesHeld},
                              {"bytes_moved_per_step", f.bytesMoved}});
  writeSummary(s, json);
}

void writeSummary(const Settings& s, const report::Json& content) {
  if (s.summary.empty()) return;
  report::Json parts{{"study", s.study}};
  parts.update(content);
  report::writeSummary(s.summary, io::provenance(), parts);
}

}  // namespace dovetail::dem_benchmark
