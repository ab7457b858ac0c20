#include "inp_cards.hpp"

#include <algorithm>

namespace dovetail::solid_io {

namespace {

/// Parts between commas; commas in quotes do not count.
std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> parts;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != ',')) continue;
    parts.push_back(trimmed(line.substr(begin, i - begin)));
    begin = i + 1;
  }
  return parts;
}

std::string withoutBlanks(std::string_view text) {
  std::string result(text);
  std::erase_if(result, [](char c) { return c == ' ' || c == '\t'; });
  return result;
}

}  // namespace

bool InpCards::peek(std::string_view& line) {
  while (!hasPeeked_ && !source_.atEnd()) {
    peekPlace_ = source_.offset();
    peeked_ = trimmed(source_.line());
    hasPeeked_ = !peeked_.empty() && peeked_.substr(0, 2) != "**";
  }
  line = peeked_;
  return hasPeeked_;
}

bool InpCards::next() {
  std::string_view line;
  while (peek(line) && line.front() != '*') hasPeeked_ = false;
  if (!peek(line)) return false;
  hasPeeked_ = false;
  place_ = peekPlace_;
  parameters_.clear();
  readCardLine(line);
  return true;
}

void InpCards::readCardLine(std::string_view line) {
  std::vector<std::string_view> parts = split(line.substr(1));
  keyword_ = lower(withoutBlanks(parts[0]));
  // A comma at the end carries the card on to the next line.
  for (std::string_view more; parts.size() > 1 && parts.back().empty() && peek(more) && more.front() != '*';) {
    hasPeeked_ = false;
    parts.pop_back();
    const auto further = split(more);
    parts.insert(parts.end(), further.begin(), further.end());
  }
  for (std::size_t k = 1; k < parts.size(); ++k) {
    if (parts[k].empty()) continue;
    const std::size_t equal = parts[k].find('=');
    std::string_view value = equal == std::string_view::npos ? "" : trimmed(parts[k].substr(equal + 1));
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"') value = value.substr(1, value.size() - 2);
    parameters_.emplace_back(lower(withoutBlanks(parts[k].substr(0, equal))), std::string(value));
  }
}

const std::string* InpCards::parameter(const std::string& name) const {
  const auto found =
      std::find_if(parameters_.begin(), parameters_.end(), [&](const auto& entry) { return entry.first == name; });
  return found == parameters_.end() ? nullptr : &found->second;
}

const std::string& InpCards::required(const std::string& name) const {
  const std::string* value = parameter(name);
  if (value == nullptr || value->empty())
    refuse("*" + keyword_ + " has no parameter " + name, "write *" + keyword_ + ", " + name + "=…");
  return *value;
}

bool InpCards::data(std::vector<std::string_view>& fields) {
  std::string_view line;
  if (!peek(line) || line.front() == '*') return false;
  hasPeeked_ = false;
  dataPlace_ = peekPlace_;
  fields = split(line);
  return true;
}

void InpCards::refuse(const std::string& problem, const std::string& remedy) const {
  source_.refuseAt(place_, problem, remedy);
}

void InpCards::refuseData(const std::string& problem, const std::string& remedy) const {
  source_.refuseAt(dataPlace_, problem, remedy);
}

}  // namespace dovetail::solid_io
