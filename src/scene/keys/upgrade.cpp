#include "dovetail/scene/upgrade.hpp"

#include <algorithm>
#include <charconv>

#include "advice.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/provenance.hpp"
#include "known_version.hpp"
#include "read/json_tree.hpp"
#include "renamed.hpp"

namespace dovetail::scene {

namespace {

struct Edit {
  Place place;
  std::string_view was, is;
};

/// "0.1.2" as numbers; nothing if it is no version.
std::vector<int> numbersOf(std::string_view version) {
  std::vector<int> numbers;
  for (const char *at = version.data(), *const end = at + version.size();; ++at) {
    int number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || number < 0) return {};
    numbers.push_back(number);
    if (next == end) return numbers;
    if (*next != '.') return {};
    at = next;
  }
}

/// Major and minor number of this program, "0.1".
std::string ownVersion() {
  const std::string& version = io::buildInfo().version;
  return version.substr(0, version.find('.', version.find('.') + 1));
}

/// Paths of lists leave the numbers of items out.
void collect(const Node& node, const std::string& path, std::vector<Edit>& edits) {
  for (const Node& item : node.items) collect(item, path, edits);
  for (const Node::Member& member : node.members) {
    const std::string own = path.empty() ? member.key : path + "." + member.key;
    const Node& value = member.value.front();
    for (const Renamed& one : renamed) {
      if (one.kind == Renamed::Kind::key && one.was == member.key && one.within == path)
        edits.push_back({member.place, one.was, one.is});
      if (one.kind == Renamed::Kind::word && one.within == own && value.kind == Node::Kind::text &&
          value.text == one.was)
        edits.push_back({value.place, one.was, one.is});
    }
    collect(value, own, edits);
  }
}

std::size_t offsetOf(const std::string& text, const Place& place) {
  std::size_t begin = 0;
  for (int line = 1; line < place.line; ++line) begin = text.find('\n', begin) + 1;
  return begin + static_cast<std::size_t>(place.column - 1);
}

}  // namespace

void requireKnownVersion(const Node& root, const std::string& name) {
  const Node* const version = root.find("version");
  if (version == nullptr) return;
  const std::vector<int> wanted = version->kind == Node::Kind::text ? numbersOf(version->text) : std::vector<int>{};
  if (wanted.empty())
    throw InputError("version is no version of Dovetail", placeName(name, version->place),
                     "write \"" + ownVersion() + "\"");
  if (wanted > numbersOf(io::buildInfo().version))
    throw InputError(
        "the scene was written for Dovetail " + version->text + ", this program is " + io::buildInfo().version,
        placeName(name, version->place), "run it with that version or a later one");
}

Upgrade upgraded(const std::string& text, const std::string& name) {
  std::vector<Edit> edits;
  const Node root = parseJson(text, name);
  requireKnownVersion(root, name);
  collect(root, "", edits);
  const std::string own = ownVersion();
  if (const Node* const version = root.find("version"); version != nullptr && version->text != own)
    edits.push_back({version->place, version->text, own});
  Upgrade result{text, {}};
  std::ranges::sort(edits, [](const Edit& a, const Edit& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  for (const Edit& edit : edits)
    result.changes.push_back(placeName(name, edit.place) + ": \"" + std::string(edit.was) + "\" is \"" +
                             std::string(edit.is) + "\"");
  std::ranges::reverse(edits);
  for (const Edit& edit : edits)
    result.text.replace(result.text.find(edit.was, offsetOf(result.text, edit.place)), edit.was.size(), edit.is);
  return result;
}

std::string adviceFor(const std::string& name, const std::vector<std::string>& candidates) {
  for (const Renamed& one : renamed)
    if (one.was == name && std::ranges::find(candidates, one.is) != candidates.end())
      return "write \"" + std::string(one.is) + "\", its name since version " + std::string(one.since) +
             (one.kind == Renamed::Kind::column ? "" : " (`dovetail upgrade FILE` does so)");
  return dovetail::adviceFor(name, candidates);
}

}  // namespace dovetail::scene
