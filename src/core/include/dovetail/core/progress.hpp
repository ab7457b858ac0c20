// Progress with an estimated time of arrival, shown only on a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace dovetail {

/// Writes one self-overwriting line ("label  42 %  ETA 12 s  note") to standard error, at most ten times a second.
/// Silent when standard error is no terminal or `enabled` is false.
class Progress {
public:
  Progress(std::string label, double total, bool enabled = true);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param done amount finished, in the unit of `total`
  void update(double done, const std::string& note = {});
  void finish();
  bool shown() const { return shown_; }

private:
  std::string label_;
  double total_;
  bool shown_;
  std::chrono::steady_clock::time_point start_, last_;
};

/// "label  42 %  ETA 12 s  note". @param fraction  done, 0 to 1 @param elapsed  s, since the start
std::string progressLine(const std::string& label, double fraction, double elapsed, const std::string& note = {});

/// "12 s", "3 min 05 s", "2 h 10 min".
std::string formatDuration(double seconds);

}  // namespace dovetail
