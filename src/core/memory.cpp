#include "dovetail/core/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace dovetail {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number behind a word in a file, or the first one where there is no word; `otherwise` if there is none.
double numberIn(const std::string& file, const std::string& word, double otherwise) {
  std::ifstream stream(file);
  std::string text;
  if (!word.empty())
    while (stream >> text && text != word) continue;
  double number = 0.0;
  return stream >> number ? number : otherwise;
}

double systemLeaves() { return 1024.0 * numberIn("/proc/meminfo", "MemAvailable:", unlimited); }

/// Pages of files that nobody has read of late are in the usage, but given up when memory is wanted.
double groupLeaves(const std::string& folder, const char* limit, const char* usage, const char* oldPages) {
  return numberIn(folder + limit, "", unlimited) - numberIn(folder + usage, "", 0.0) +
         numberIn(folder + "/memory.stat", oldPages, 0.0);
}

/// Of the group and those that it is in. Lines are "0::/path" (version 2) or "4:memory:/path" (version 1).
double groupsLeave() {
  std::ifstream stream("/proc/self/cgroup");
  double least = unlimited;
  for (std::string line; std::getline(stream, line);) {
    const bool second = line.starts_with("0::");
    const std::size_t colon = line.find(":memory:");
    if (!second && colon == std::string::npos) continue;
    std::string path = line.substr(second ? 3 : colon + 8);
    for (bool top = false; !top;) {
      top = path.size() <= 1;
      least = std::min(least,
                       second ? groupLeaves("/sys/fs/cgroup" + path, "/memory.max", "/memory.current", "inactive_file")
                              : groupLeaves("/sys/fs/cgroup/memory" + path, "/memory.limit_in_bytes",
                                            "/memory.usage_in_bytes", "total_inactive_file"));
      path.erase(std::min(path.rfind('/'), path.size()));
    }
  }
  return least;
}

double pagesOf(int column) {
  std::ifstream stream("/proc/self/statm");
  double pages = 0.0;
  for (int k = 0; k <= column; ++k)
    if (!(stream >> pages)) return 0.0;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double addressesLeave() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  return static_cast<double>(limit.rlim_cur) - pagesOf(0);
}

}  // namespace

double availableMemory() { return std::max(0.0, std::min({systemLeaves(), groupsLeave(), addressesLeave()})); }
double residentMemory() { return pagesOf(1); }

}  // namespace dovetail
