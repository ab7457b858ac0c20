// Parts, instances and the name spaces that they make.
#include <limits>

#include "abaqus_reader.hpp"

namespace dovetail::solid_io {

void AbaqusReader::enterPart() {
  cards_.requireKnown({{"name"}});
  if (++parts_ > 1) cards_.refuse("there is a second *part", "write one part, or a flat file (no parts, no assembly)");
  if (const std::string* name = cards_.parameter("name")) part_ = *name;
  if (builder_.nodeCount() > 0)
    cards_.refuse("nodes come before the *part", "write them into the part, or after it into the assembly");
  cards_.requireNoData();
  inPart_ = true;
}

void AbaqusReader::enterInstance() {
  cards_.requireKnown({{"name"}, {"part"}});
  if (++instances_ > 1)
    cards_.refuse("there is a second *instance", "write one, or a flat file (no parts, no assembly)");
  if (const std::string* part = cards_.parameter("part"); part && parts_ > 0 && lower(*part) != lower(part_))
    cards_.refuse("there is no *part " + shown(*part), "name " + shown(part_));
  if (const std::string* name = cards_.parameter("name")) instance_ = *name;
  requireUnmoved();
  ++parts_;
  inPart_ = true;
}

void AbaqusReader::requireUnmoved() {
  int line = 0;
  for (std::vector<std::string_view> fields; cards_.data(fields); ++line) {
    // A translation; then two points of an axis and an angle.
    const std::size_t from = line == 0 ? 0 : 6, most = line == 0 ? 3 : 7;
    while (!fields.empty() && fields.back().empty()) fields.pop_back();
    if (line > 1 || fields.size() > most)
      cards_.refuseData("an instance has more than a translation and a rotation", "give x, y, z and a, b, angle");
    for (std::size_t k = from; k < fields.size(); ++k)
      if (!fields[k].empty() && source_.parseReal(fields[k]) != 0.0)
        cards_.refuseData("the instance is moved",
                          "write its nodes in their final position, without a translation or rotation");
  }
}

void AbaqusReader::leavePart() {
  cards_.requireNoData();
  inPart_ = false;
}

Space AbaqusReader::spaceOfCard() const {
  const std::string* instance = cards_.parameter("instance");
  if (instance == nullptr) return space();
  if (instances_ == 0 || lower(*instance) != lower(instance_))
    cards_.refuse("there is no *instance " + shown(*instance),
                  instances_ == 0 ? "leave the parameter instance out" : "name " + shown(instance_));
  return Space::part;
}

bool AbaqusReader::takeInstance(std::string& name) const {
  const std::string prefix = lower(instance_) + ".";
  if (instances_ == 0 || lower(name).substr(0, prefix.size()) != prefix) return false;
  name = name.substr(prefix.size());
  return true;
}

Label AbaqusReader::newLabel(std::map<Label, Label>& aliases, Label label, const char* what, std::size_t place) {
  if (parts_ == 0 || space() == Space::part) return label;
  const Label ours = std::numeric_limits<Label>::min() + static_cast<Label>(aliases.size());
  if (!aliases.emplace(label, ours).second)
    source_.refuseAt(place, std::string(what) + " " + std::to_string(label) + " occurs twice",
                     "give each a number of its own");
  return ours;
}

Label AbaqusReader::labelOf(const std::map<Label, Label>& aliases, const Member& member) const {
  const auto alias = member.space == Space::model ? aliases.find(member.label) : aliases.end();
  return alias == aliases.end() ? member.label : alias->second;
}

void AbaqusReader::nameAsInFile(const std::map<Label, Label>& aliases, std::vector<std::int64_t>& numbers) {
  std::map<Label, Label> given;
  for (const auto& [label, ours] : aliases) given[ours] = label;
  for (std::int64_t& number : numbers)
    if (const auto found = given.find(number); found != given.end()) number = found->second;
}

}  // namespace dovetail::solid_io
