// What a run found: printed, and as JSON.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/summary.hpp"

namespace dovetail::benchmark {

/// A figure: its key in summaries, and how reports say it. Without a label it is in the summary alone, without a key
/// in the report alone; a label alone is a heading. Reports leave out what is not known (null, NaN).
struct Line {
  std::string key;
  report::Json value;
  std::string label = {}, pattern = "%.3e";  ///< of std::printf, with the unit
  double factor = 1.0;                       ///< from the value to what is printed
};
using Lines = std::vector<Line>;

/// How a run went.
struct RunFigures {
  bool finished = false;  ///< reached the end it was told
  bool stable = false;    ///< finished, and its energy stayed within 1.5 times what was available
  std::string failure;    ///< what broke down, when and where
  std::int64_t steps = 0;
  double endTime = 0.0, wallSeconds = 0.0;  ///< s; of the loop, without writing files
  double dt = 0.0;                          ///< s
  double largestExcess = 0.0;               ///< kinetic + elastic energy over what was available
};

/// What stands in every report.
struct RunData {
  std::string scene;  ///< that was run, in full, as JSON
  EnergyLedger ledger;
  Profile profile;
  io::TimeSeries series{{"time_s"}};
  /// Velocity along a bar, a row per layer and frame that was observed, if the case has one.
  std::optional<io::TimeSeries> velocityProfile;
};

/// Fills the ledger and the series from what they are told to be made of, in the order in which it is told.
class Recorder {
public:
  using Value = std::function<double()>;
  explicit Recorder(RunData& data) : data_(data) {}
  EnergyLedger::Id stored(const std::string& name, Value joules) {
    channels_.push_back(std::move(joules));
    return data_.ledger.addStored(name);
  }
  EnergyLedger::Id booked(const std::string& name, Value joules) {
    channels_.push_back(std::move(joules));
    return data_.ledger.addBooked(name);
  }
  void column(const std::string& name, Value value);
  /// Columns <head>x<tail>, <head>y<tail>, <head>z<tail>.
  void columns(const std::string& head, const std::string& tail, const std::function<Vec3()>& value);
  /// A column of what the ledger has in the channel, 0 without one.
  void column(const std::string& name, std::optional<EnergyLedger::Id> channel);

  void setLedger();
  void addRow();

private:
  RunData& data_;
  std::vector<Value> channels_, columns_;
  std::vector<std::string> names_;
};

inline double secondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Runs `loop`, which returns whether it went to the end, and notes its time and its breakdown.
template <class Loop>
void conduct(RunFigures& figures, Loop loop) {
  const auto begin = std::chrono::steady_clock::now();
  try {
    figures.finished = loop();
  } catch (const NumericalError& error) {
    figures.failure = error.what();
  }
  figures.wallSeconds += secondsSince(begin);
}

/// "t = 0.5 s, step 100"
std::string moment(double time, std::int64_t step);
/// What an interrupted run says of itself.
std::string interrupted(double time, std::int64_t step);

/// Steps, times and the step, with keys; `contactTime` in s.
Lines timeLines(const RunFigures& figures, double contactTime, double criticalDt);

/// A report with its heads: the build, what differs from `standard`, the lines, the ledger, the stages, failure.
void printReport(std::ostream& out, const std::string& title, const io::KeyValues& settings,
                 const io::KeyValues& standard, const Lines& lines, const RunFigures& figures, const RunData& data);

/// The lines by key.
report::Json figuresAsJson(const Lines& lines);
/// @throws InputError as io::writeFileAtomically
/// @param scene  in full, as JSON text
void writeSummary(const std::string& file, const Lines& lines, const RunData& data, const io::KeyValues& settings,
                  const std::string& scene);

}  // namespace dovetail::benchmark
