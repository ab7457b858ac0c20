// One warning for many parts with the same fault.
#include <cctype>
#include <map>

#include "warnings.hpp"

namespace dovetail::scene {

namespace {

/// Without numbers and what stands in quotes.
std::string kindOf(const std::string& line) {
  std::string kind;
  bool isQuoted = false, afterDigit = false;
  for (const char c : line) {
    if (c == '"') isQuoted = !isQuoted;
    const bool isDigit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    const bool isNumber = isDigit || c == '-' || (afterDigit && (c == 'e' || c == '.' || c == '+'));
    if (!isQuoted && !isNumber) kind += c;
    afterDigit = isNumber;
  }
  return kind;
}

}  // namespace

Lines onePerKind(const Lines& lines) {
  std::map<std::string, std::size_t> place;
  Lines first;
  std::vector<std::size_t> count;
  for (const std::string& line : lines) {
    const auto [found, isNew] = place.emplace(kindOf(line), first.size());
    if (isNew) first.push_back(line), count.push_back(0);
    ++count[found->second];
  }
  for (std::size_t k = 0; k < first.size(); ++k)
    if (count[k] > 1) first[k] += " The same holds for " + std::to_string(count[k] - 1) + " more.";
  return first;
}

}  // namespace dovetail::scene
