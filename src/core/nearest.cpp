#include "dovetail/core/nearest.hpp"

#include <algorithm>
#include <cctype>

namespace dovetail {

namespace {

std::string plain(const std::string& name) {
  std::string out;
  for (const char c : name)
    if (c != '_' && c != '-' && c != ' ') out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// Damerau and Levenshtein's distance, neighbours swapped at most once.
std::size_t changes(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t differs = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + differs});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest(const std::string& name, const std::vector<std::string>& candidates) {
  const std::string wanted = plain(name.substr(0, 64));
  std::string best;
  std::size_t least = 1000;
  for (const std::string& candidate : candidates) {
    const std::string known = plain(candidate);
    const std::size_t count = changes(wanted, known);
    if (count < least && 3 * count <= std::max(wanted.size(), known.size())) {
      least = count;
      best = candidate;
    }
  }
  return best;
}

std::string adviceFor(const std::string& name, const std::vector<std::string>& candidates) {
  if (const std::string near = nearest(name, candidates); !near.empty()) return "write \"" + near + "\"";
  if (candidates.empty()) return "leave it out";
  std::string list;
  for (const std::string& candidate : candidates)
    list.append(list.empty() ? "\"" : ", \"").append(candidate).append("\"");
  return (candidates.size() == 1 ? "write " : "write one of ") + list;
}

}  // namespace dovetail
