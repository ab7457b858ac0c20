#include "dovetail/io/provenance.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::io {

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos && colon + 2 < line.size())
      return line.substr(colon + 2);
  }
  utsname system{};
  return uname(&system) == 0 && system.machine[0] != '\0' ? system.machine : "unknown";
}

namespace {
std::pair<std::string, std::string> versionEntry() { return {"version", "dovetail " + buildInfo().version}; }
}  // namespace

KeyValues provenance(const KeyValues& settings) {
  const BuildInfo& build = buildInfo();
  KeyValues entries{versionEntry(),
                    {"commit", build.commit},
                    {"compiler", build.compiler},
                    {"flags", build.flags},
                    {"build type", build.buildType},
                    {"processor", processorName()},
                    {"threads", std::to_string(threads())}};
  std::set<std::string> seen;
  for (const auto& [key, value] : settings) {
    if (key.empty()) throw InputError("a setting of value '" + value + "' has no name", "provenance", "name it");
    if (!seen.insert(key).second)
      throw InputError("the setting '" + key + "' is given twice", "provenance", "give it once");
    entries.emplace_back("setting." + key, value);
  }
  return entries;
}

KeyValues withMark(KeyValues provenance) {
  const auto isVersion = [](const auto& entry) { return entry == versionEntry(); };
  if (std::none_of(provenance.begin(), provenance.end(), isVersion))
    provenance.insert(provenance.begin(), versionEntry());
  return provenance;
}

std::string provenanceLines(const KeyValues& provenance, const std::string& prefix) {
  const auto onOneLine = [](const std::string& text) {
    std::string line;
    for (const char c : text) {
      if (c == '\n')
        line += "\\n";
      else if (c == '\r')
        line += "\\r";
      else if (c == '\\')
        line += "\\\\";
      else
        line += c;
    }
    return line;
  };
  std::string lines;
  for (const auto& [key, value] : provenance) lines += prefix + onOneLine(key) + ": " + onOneLine(value) + "\n";
  return lines;
}

}  // namespace dovetail::io
