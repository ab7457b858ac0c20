#include "dovetail/core/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace dovetail {

std::string formatDuration(double seconds) {
  const long total = std::max(0L, static_cast<long>(seconds + 0.5));
  char text[48];
  if (total < 60)
    std::snprintf(text, sizeof text, "%ld s", total);
  else if (total < 3600)
    std::snprintf(text, sizeof text, "%ld min %02ld s", total / 60, total % 60);
  else
    std::snprintf(text, sizeof text, "%ld h %02ld min", total / 3600, total / 60 % 60);
  return text;
}

std::string progressLine(const std::string& label, double fraction, double elapsed, const std::string& note) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", 100.0 * fraction);
  const std::string eta = fraction > 0.0 ? formatDuration(elapsed * (1.0 - fraction) / fraction) : "?";
  return label + "  " + percent + "  ETA " + eta + "  " + note;
}

Progress::Progress(std::string label, double total, bool enabled)
    : label_(std::move(label)),
      total_(total),
      shown_(enabled && isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

Progress::~Progress() { finish(); }

void Progress::update(double done, const std::string& note) {
  if (!shown_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const std::string line = progressLine(label_, total_ > 0.0 ? done / total_ : 0.0, elapsed, note);
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
}

void Progress::finish() {
  if (!shown_) return;
  std::fprintf(stderr, "\r\033[K");
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace dovetail
