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

constexpr std::string_view meshCards[] = {"node", "element", "nset", "elset", "surface", "part", "instance", "include"};

std::string withoutBlanks(std::string_view text) {
  std::string result(text);
  std::erase_if(result, [](char c) { return c == ' ' || c == '\t'; });
  return result;
}

/// A comma at the end carries a card on to the next line; many programs write one before data, too.
bool continuesCard(std::string_view line) {
  if (line.front() == '*') return false;
  const std::string first = lower(split(line)[0]);
  return first.find('=') != std::string::npos || first == "generate" || first == "internal" || first == "unsorted";
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

std::string InpCards::textBeforeCards() {
  std::string first;
  for (std::string_view line; peek(line) && line.front() != '*'; hasPeeked_ = false) {
    const std::string word = lower(line.substr(0, line.find_first_of(", \t")));
    const bool ofUs = std::find(std::begin(meshCards), std::end(meshCards), word) != std::end(meshCards);
    const std::size_t star = line.find_first_of('*');
    const bool card = star != std::string_view::npos && star + 1 < line.size() && line[star + 1] != '*';
    if (ofUs || card || line.find(',') != std::string_view::npos)
      source_.refuseAt(peekPlace_, "there is " + shown(line) + " before the first card",
                       "begin with a card such as *node");
    if (first.empty()) first = shown(line);
  }
  return first;
}

void InpCards::readCardLine(std::string_view line) {
  std::vector<std::string_view> parts = split(line.substr(1));
  keyword_ = lower(withoutBlanks(parts[0]));
  requireComma(parts[0]);
  for (std::string_view more; parts.size() > 1 && parts.back().empty() && peek(more) && continuesCard(more);) {
    hasPeeked_ = false;
    parts.pop_back();
    const auto further = split(more);
    parts.insert(parts.end(), further.begin(), further.end());
  }
  for (std::size_t k = 1; k < parts.size(); ++k) {
    if (parts[k].empty()) continue;
    const std::size_t equal = parts[k].find('=');
    std::string_view value = equal == std::string_view::npos ? "" : trimmed(parts[k].substr(equal + 1));
    const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
    if (quoted) value = value.substr(1, value.size() - 2);
    parameters_.push_back({lower(withoutBlanks(parts[k].substr(0, equal))), std::string(value), quoted});
  }
}

/// "*NSET NSET=top" is no card *NSETNSET=top to pass over.
void InpCards::requireComma(std::string_view card) const {
  const std::size_t blank = trimmed(card).find_first_of(" \t");
  const std::string first = lower(trimmed(card).substr(0, blank));
  const bool ours = std::find(std::begin(meshCards), std::end(meshCards), first) != std::end(meshCards);
  if (ours && blank != std::string_view::npos && card.find('=') != std::string_view::npos)
    refuse("there is no comma after *" + first, "write *" + first + ", …");
}

void InpCards::requireKnown(const std::vector<Parameter>& known) const {
  std::string names;
  for (const Parameter& one : known) names += (names.empty() ? "" : ", ") + std::string(one.name);
  for (const Given& given : parameters_) {
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const Parameter& one) { return one.name == given.name; });
    if (found == known.end())
      refuse("*" + keyword_ + " has the parameter " + shown(given.name), "use " + (names.empty() ? "none" : names));
    if (parameter(given.name) != &given.value)
      refuse("*" + keyword_ + " has the parameter " + given.name + " twice", "give it once");
    if (found->kind == Parameter::flag && !given.value.empty())
      refuse("the parameter " + given.name + " has the value " + shown(given.value), "write it without one");
    requireWhole(given.name, given.value, given.quoted);
  }
}

/// A forgotten comma or quote makes the next parameter a part of the value.
void InpCards::requireWhole(const std::string& name, const std::string& value, bool quoted) const {
  if (quoted) return;
  const std::size_t blank = value.find_last_of(" \t");
  const std::string last = blank == std::string::npos ? "" : lower(value.substr(blank + 1));
  if (value.find_first_of("=\"") != std::string::npos || last == "generate" || last == "internal" || last == "unsorted")
    refuse("the parameter " + name + " has the value " + shown(value),
           "put commas between parameters, and quotes on both sides of a name");
}

void InpCards::requireNoData() {
  if (std::vector<std::string_view> fields; data(fields))
    refuseData("*" + keyword_ + " has a line of data", "leave it out, or begin a card with *");
}

const std::string* InpCards::parameter(const std::string& name) const {
  const auto found =
      std::find_if(parameters_.begin(), parameters_.end(), [&](const Given& given) { return given.name == name; });
  return found == parameters_.end() ? nullptr : &found->value;
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
