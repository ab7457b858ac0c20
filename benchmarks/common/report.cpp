#include "common/report.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "dovetail/core/finite.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/report/summary.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::benchmark {

using report::format;
using report::Json;

void Recorder::column(const std::string& name, Value value) {
  names_.push_back(name);
  columns_.push_back(std::move(value));
}

void Recorder::columns(const std::string& head, const std::string& tail, const std::function<Vec3()>& value) {
  column(head + "x" + tail, [value] { return value().x; });
  column(head + "y" + tail, [value] { return value().y; });
  column(head + "z" + tail, [value] { return value().z; });
}

void Recorder::column(const std::string& name, std::optional<EnergyLedger::Id> channel) {
  column(name, [this, channel] { return channel ? data_.ledger.channels()[*channel].joules : 0.0; });
}

void Recorder::setLedger() {
  for (EnergyLedger::Id id = 0; id < channels_.size(); ++id) data_.ledger.set(id, channels_[id]());
}

void Recorder::addRow() {
  if (data_.series.rows() == 0) data_.series = io::TimeSeries(names_);
  std::vector<double> row;
  for (const Value& value : columns_) row.push_back(value());
  data_.series.append(row);
}

std::string moment(double time, std::int64_t step) {
  return "t = " + formatNumber(time) + " s, step " + std::to_string(step);
}

std::string interrupted(double time, std::int64_t step) {
  return Error(io::nameOfInterruption(), moment(time, step), "run it again").what();
}

Lines timeLines(const RunFigures& f, double contactTime, double criticalDt) {
  const double steps = static_cast<double>(std::max<std::int64_t>(1, f.steps));
  return {{"", nullptr, "Time"},
          {"finished", f.finished},
          {"stable", f.stable},
          {"failure", f.failure},
          {"steps", f.steps, "steps", "%.0f"},
          {"end_time_s", f.endTime, "end", "%.6g s"},
          {"wall_seconds", f.wallSeconds, "run time", "%.3f s"},
          {"seconds_per_step", f.wallSeconds / steps, "a step", "%.2f us per step", 1e6},
          {"dt_s", f.dt, "dt", "%.4e s"},
          {"", f.dt / contactTime, "  over the contact time", "%.4f"},
          {"", f.dt / criticalDt, "  over the critical step", "%.1f %%", 100.0},
          {"largest_energy_over_available", f.largestExcess}};
}

void printReport(std::ostream& out, const std::string& title, const io::KeyValues& settings,
                 const io::KeyValues& standard, const Lines& lines, const RunFigures& figures, const RunData& data) {
  const io::BuildInfo& build = io::buildInfo();
  out << title << "\n  " << build.version << " (" << build.commit.substr(0, 12) << "), " << build.compiler << ", "
      << io::processorName() << "\n  changed    ";
  bool any = false;
  for (const auto& row : settings) {
    if (std::find(standard.begin(), standard.end(), row) != standard.end()) continue;
    out << (std::exchange(any, true) ? ", " : "") << row.first << ' ' << row.second;
  }
  out << (any ? "" : "nothing: all settings as they come") << '\n';
  for (const Line& line : lines) {
    if (line.label.empty() || (!line.key.empty() && line.value.is_null())) continue;
    if (line.value.is_null())
      out << line.label << '\n';
    else if (line.value.is_string())
      out << format("  %-48s ", line.label.c_str()) << line.value.get<std::string>() << '\n';
    else if (const double value = line.factor * line.value.get<double>(); std::isfinite(value))
      out << format("  %-48s ", line.label.c_str()) << format(line.pattern.c_str(), value) << '\n';
  }
  out << "Ledger at the end\n" << data.ledger << data.profile;
  if (!figures.failure.empty())
    out << "The run broke down: " << figures.failure << '\n';
  else if (!figures.stable)
    out << format("Not stable: kinetic + elastic energy reached %.3g times what was available\n",
                  figures.largestExcess);
}

Json figuresAsJson(const Lines& lines) {
  Json json = Json::object();
  for (const Line& line : lines)
    if (!line.key.empty())
      json[line.key] = line.value.is_number_float() ? report::numberOrNull(line.value.get<double>()) : line.value;
  return json;
}

void writeSummary(const std::string& file, const Lines& lines, const RunData& data, const io::KeyValues& settings,
                  const std::string& scene) {
  report::writeSummary(file, io::provenance(),
                       {{"results", figuresAsJson(lines)},
                        {"energy", report::energyOf(data.ledger)},
                        {"figures", report::figuresOf(data.series)},
                        {"times", report::timesOf(data.profile)},
                        {"settings", report::objectOf(settings)},
                        {"scene", Json::parse(scene)}});
}

}  // namespace dovetail::benchmark
