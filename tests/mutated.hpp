// Texts that are damaged at random.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>

namespace dovetail::test {

/// One to four changes: a byte, a digit, a run left out or doubled, the end cut off.
inline std::string mutated(const std::string& text, std::mt19937& random) {
  std::string result = text;
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (std::size_t change = 0, changes = 1 + below(4); change < changes && result.size() > 2; ++change) {
    const std::size_t at = below(result.size()), length = 1 + below(std::min<std::size_t>(40, result.size() - at));
    switch (below(6)) {
      case 0:
        result[at] = static_cast<char>(below(256));
        break;
      case 1:
        result[at] = static_cast<char>('0' + below(10));
        break;
      case 2:
        result.erase(at, length);
        break;
      case 3:
        result.insert(at, result.substr(below(result.size()), length));
        break;
      case 4:
        result.resize(at);
        break;
      default:
        result[at] = " ,\n-$*\"=e."[below(10)];
    }
  }
  return result;
}

}  // namespace dovetail::test
