// Summaries as text.
#include <cstdlib>
#include <sstream>

#include "dovetail/report/run_record.hpp"

namespace dovetail::report {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Takes the last word off the line; false if it is no number.
bool takeNumber(std::string& line, double& value) {
  line = trimmed(line);
  const std::size_t space = line.find_last_of(' ');
  if (space == std::string::npos) return false;
  char* end = nullptr;
  value = std::strtod(line.c_str() + space, &end);
  if (*end != '\0') return false;
  line = trimmed(line.substr(0, space));
  return true;
}

bool takeChannel(std::string line, RunRecord& record) {
  double change = 0.0;
  EnergyLedger::Channel channel{"", EnergyLedger::Kind::stored};
  if (!takeNumber(line, change) || !takeNumber(line, channel.joules) || !takeNumber(line, channel.joulesAtOpening))
    return false;
  const std::string booked = " [booked]";
  if (line.ends_with(booked)) {
    channel.kind = EnergyLedger::Kind::booked;
    line.resize(line.size() - booked.size());
  }
  channel.name = line;
  record.channels.push_back(channel);
  return true;
}

/// "name  0.085  99.1 %  1.7": seconds, share, µs per call
bool takeStage(std::string line, RunRecord& record) {
  double microseconds = 0.0, fraction = 0.0;
  Profile::Row row;
  if (!takeNumber(line, microseconds)) return false;
  if (line.ends_with("%")) line.pop_back();
  if (!takeNumber(line, fraction) || !takeNumber(line, row.seconds)) return false;
  row.name = line;
  row.calls = microseconds > 0.0 ? static_cast<std::int64_t>(1e6 * row.seconds / microseconds + 0.5) : 0;
  record.stages.push_back(row);
  return true;
}

/// What stands behind `head` in the line, up to `end`.
std::string behind(const std::string& line, const std::string& head, const std::string& end) {
  const std::size_t at = line.find(head);
  if (at == std::string::npos) return "";
  return line.substr(at + head.size(), line.find(end, at + head.size()) - at - head.size());
}

void takeLine(const std::string& line, RunRecord& record) {
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) record.figures.emplace_back(name, value);
  };
  if (line.starts_with("stage ") && line.find(": ") != std::string::npos)
    add("seconds of " + line.substr(0, line.find(": ")), behind(line, ": ", " s"));
  else if (line.starts_with("step ")) {
    add("step (s)", behind(line, "step ", " s"));
    add("critical step at the end (s)", behind(line, "at most ", " s"));
    add("set by", behind(line, "set by ", "\n"));
  } else if (line.starts_with("residual over all impulses ")) {
    add("momentum residual over all impulses", behind(line, "impulses ", ","));
    add("residual of moments over their impulses", behind(line, "moments ", ";"));
    add("mass residual (kg)", behind(line, " kg, residual ", " kg"));
  } else if (line.starts_with("WARNING") || line.starts_with("NOT "))
    record.warnings.push_back(line);
  else
    record.notes.push_back(line);
}

}  // namespace

void readSummaryText(const std::string& text, RunRecord& record) {
  enum class Part { lines, channels, momenta, stages } part = Part::lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("#")) continue;
    record.summary += line + "\n";
    if (line.starts_with("  channel (J)"))
      part = Part::channels;
    else if (line.starts_with("  stage "))
      part = Part::stages;
    else if (line.starts_with("momentum ("))
      part = Part::momenta;
    else if (part == Part::channels && line.starts_with("  residual "))
      record.residual = std::strtod(trimmed(line).c_str() + 8, nullptr);
    else if (part == Part::channels && line.starts_with("  stored total"))
      continue;
    else if (part == Part::channels && takeChannel(line, record))
      continue;
    else if (part == Part::stages && takeStage(line, record))
      continue;
    else if (part != Part::momenta || line.starts_with("  residual over"))
      takeLine(trimmed(line), record);
  }
}

}  // namespace dovetail::report
