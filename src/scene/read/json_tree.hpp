// A JSON document whose values know where they stand.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dovetail::scene {

struct Place {
  int line = 0, column = 0;  ///< from 1; 0: not from a file
  /// Of the file; none: of the one that all is read from.
  std::shared_ptr<const std::filesystem::path> file{};
};

struct Node {
  enum class Kind { null, boolean, number, text, list, object };
  Kind kind = Kind::null;
  bool boolean = false;
  double number = 0.0;
  bool whole = false;  ///< the number is written as an integer
  std::string text;
  std::vector<Node> items;
  struct Member {
    std::string key;
    Place place;
    std::vector<Node> value;  ///< one
  };
  std::vector<Member> members;  ///< in the order of the file
  Place place;

  const Node* find(const std::string& key) const;
  Node* find(const std::string& key);
};

/// "an object", "the number 5", "the text \"a\""
std::string nameOf(const Node& node);

/// JSON with comments. @param name  of the file
/// @throws InputError naming file, line and column: no JSON, a key twice in one object, more than 64 levels, a number
/// beyond doubles, control characters in a text, something behind the end
Node parseJson(const std::string& text, const std::string& name);

/// Calls act(place) for the places of the node and of all within it.
template <class Act>
void forEachPlace(Node& node, const Act& act) {
  act(node.place);
  for (Node& item : node.items) forEachPlace(item, act);
  for (Node::Member& member : node.members) {
    act(member.place);
    for (Node& value : member.value) forEachPlace(value, act);
  }
}

/// "scene.json:3:14", or the name alone; that of the place's own file where it has one.
std::string placeName(const std::string& name, const Place& place);

}  // namespace dovetail::scene
