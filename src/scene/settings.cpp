#include "settings.hpp"

#include <charconv>

#include "dovetail/core/error.hpp"
#include "nearest.hpp"

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

void forgetPlaces(Node& node) {
  node.place = {};
  for (Node& item : node.items) forgetPlaces(item);
  for (Node::Member& member : node.members) {
    member.place = {};
    for (Node& value : member.value) forgetPlaces(value);
  }
}

Node& itemOf(Node& list, const std::string& key, const std::string& where) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
  if (error != std::errc{} || end != key.data() + key.size() || number >= list.items.size())
    throw InputError("there is no item \"" + key + "\" in a list of " + std::to_string(list.items.size()), where,
                     "count items from 0");
  return list.items[number];
}

Node& memberOf(Node& holder, const std::string& key, const std::string& where, bool mayBeNew) {
  if (holder.kind == Node::Kind::list) return itemOf(holder, key, where);
  if (Node* found = holder.kind == Node::Kind::object ? holder.find(key) : nullptr) return *found;
  std::vector<std::string> names;
  for (const Node::Member& member : holder.members) names.push_back(member.key);
  if (holder.kind != Node::Kind::object || !mayBeNew)
    throw InputError("the scene has no \"" + key + "\" there", where, adviceFor(key, names));
  holder.members.push_back({key, {}, {Node{}}});
  return holder.members.back().value[0];
}

std::vector<std::string> namesIn(const Node& root, const Node* let) {
  std::vector<std::string> names;
  for (const Node* const holder : {let, &root})
    if (holder)
      for (const Node::Member& member : holder->members) names.push_back(member.key);
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
  if (!isParameter && path.find('.') == std::string::npos && !root.find(path))
    throw InputError("the scene has no parameter or key \"" + path + "\"", where, adviceFor(path, namesIn(root, let)));
  for (bool last = false; !last;) {
    const std::size_t dot = path.find('.');
    last = dot == std::string::npos;
    node = &memberOf(*node, path.substr(0, dot), where, last);
    if (!last) path.erase(0, dot + 1);
  }
  Node value = valueFrom(setting.substr(equals + 1), where);
  forgetPlaces(value);
  *node = std::move(value);
}

}  // namespace dovetail::scene
