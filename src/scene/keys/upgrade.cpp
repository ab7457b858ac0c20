#include "dovetail/scene/upgrade.hpp"

#include <algorithm>

#include "read/json_tree.hpp"
#include "renamed.hpp"

namespace dovetail::scene {

namespace {

struct Edit {
  Place place;
  std::string_view was, is;
};

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

Upgrade upgraded(const std::string& text, const std::string& name) {
  std::vector<Edit> edits;
  collect(parseJson(text, name), "", edits);
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

}  // namespace dovetail::scene
