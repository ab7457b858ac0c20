#include "settings.hpp"

#include <charconv>

#include "advice.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::scene {

namespace {

Node valueFrom(const std::string& text, const std::string& where) {
  Node node;
  try {
    node = parseJson(text, where);
  } catch (const InputError&) {
    node.kind = Node::Kind::text;
    node.text = text;
  }
  return node;
}

Node& itemOf(Node& list, const std::string& key, const std::string& where) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
  if (error != std::errc{} || end != key.data() + key.size() || number >= list.items.size())
    throw InputError("there is no item \"" + key + "\" in a list of " + std::to_string(list.items.size()), where,
                     "count items from 0");
  return list.items[number];
}

/// The member of that name, made if there is none: the reader tells names that nobody knows.
Node& memberOf(Node& holder, const std::string& key, const std::string& where) {
  if (holder.kind == Node::Kind::list) return itemOf(holder, key, where);
  if (holder.kind != Node::Kind::object)
    throw InputError(nameOf(holder) + " has no \"" + key + "\"", where, "give the path of keys of an object");
  if (Node* found = holder.find(key)) return *found;
  Node made;
  made.kind = Node::Kind::object;
  Node::Member member{key, {}, {}};
  member.value.push_back(std::move(made));
  holder.members.push_back(std::move(member));
  return holder.members.back().value[0];
}

std::vector<std::string> namesIn(const Node& holder) {
  std::vector<std::string> names;
  for (const Node::Member& member : holder.members) names.push_back(member.key);
  return names;
}

}  // namespace

void applySetting(Node& root, const std::string& setting) {
  const std::string where = "--set " + setting.substr(0, 80);
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("a setting has no key and value", where, "write --set key=value");
  std::string path = setting.substr(0, equals);
  Node* let = root.kind == Node::Kind::object ? root.find("let") : nullptr;
  const bool isParameter = let && let->kind == Node::Kind::object && let->find(path);
  Node* node = isParameter ? let : &root;
  if (let && !isParameter && !root.find(path.substr(0, path.find('.'))))
    if (const std::string near = nearest(path, namesIn(*let)); !near.empty())
      throw InputError("the scene has no parameter \"" + path + "\"", where, "write \"" + near + "\"");
  for (bool last = false; !last;) {
    const std::size_t dot = path.find('.');
    last = dot == std::string::npos;
    node = &memberOf(*node, path.substr(0, dot), where);
    if (!last) path.erase(0, dot + 1);
  }
  Node value = valueFrom(setting.substr(equals + 1), where);
  forEachPlace(value, [](Place& place) { place = {}; });
  *node = std::move(value);
}

}  // namespace dovetail::scene
