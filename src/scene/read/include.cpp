#include "include.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/plain_text.hpp"
#include "keys/known_version.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

bool listsObjects(const Node& node) {
  return node.kind == Node::Kind::list && std::all_of(node.items.begin(), node.items.end(),
                                                      [](const Node& item) { return item.kind == Node::Kind::object; });
}

/// `over` on top of `base`.
void merge(Node& base, Node over) {
  if (base.kind == Node::Kind::object && over.kind == Node::Kind::object) {
    for (Node::Member& member : over.members)
      if (Node* const there = base.find(member.key))
        merge(*there, std::move(member.value[0]));
      else
        base.members.push_back(std::move(member));
    base.place = over.place;
  } else if (listsObjects(base) && listsObjects(over)) {
    std::move(over.items.begin(), over.items.end(), std::back_inserter(base.items));
  } else {
    base = std::move(over);
  }
}

class Includer {
public:
  explicit Includer(std::string name) : name_(std::move(name)) {}

  Node resolve(Node scene, const fs::path& folder) {
    if (scene.kind != Node::Kind::object) return scene;
    const auto found = std::find_if(scene.members.begin(), scene.members.end(),
                                    [](const Node::Member& member) { return member.key == "include"; });
    if (found == scene.members.end()) return scene;
    const Node list = std::move(found->value[0]);
    scene.members.erase(found);
    if (list.kind != Node::Kind::list) refuse(list, "\"include\" is " + nameOf(list), "write a list of names of files");
    Node whole;
    whole.kind = Node::Kind::object;
    for (const Node& item : list.items) merge(whole, included(item, folder));
    merge(whole, std::move(scene));
    return whole;
  }

  void enter(const fs::path& file) { chain_.push_back(file); }

private:
  [[noreturn]] void refuse(const Node& node, const std::string& problem, const std::string& remedy) const {
    throw InputError(problem, placeName(name_, node.place) + ", include", remedy);
  }

  Node included(const Node& item, const fs::path& folder) {
    if (item.kind != Node::Kind::text || item.text.empty())
      refuse(item, nameOf(item) + " where the name of a file is expected", "write a text in quotes");
    const fs::path file = (folder / item.text).lexically_normal();
    std::error_code error;
    const fs::path same = fs::weakly_canonical(file, error);
    if (std::find(chain_.begin(), chain_.end(), same) != chain_.end()) {
      std::string names;
      for (const fs::path& one : chain_) names += one.string() + " -> ";
      refuse(item, "a scene includes itself: " + names + same.string(), "leave one of them out");
    }
    constexpr std::size_t deepest = 64;
    if (chain_.size() > deepest)
      refuse(item, "scenes are included more than " + std::to_string(deepest) + " deep", "nest fewer");
    if (!seen_.insert(same).second) return objectWithout();
    Node scene = parseJson(textOfScene(file, placeName(name_, item.place) + ", include"), file.string());
    if (scene.kind != Node::Kind::object)
      refuse(item, file.string() + " holds " + nameOf(scene) + " where an object is expected", "write { … } there");
    requireKnownVersion(scene, file.string());
    std::erase_if(scene.members, [](const auto& member) { return member.key == "version"; });  // is its own
    const auto own = std::make_shared<const fs::path>(file);
    forEachPlace(scene, [&](Place& place) { place.file = own; });
    chain_.push_back(same);
    scene = resolve(std::move(scene), file.parent_path());
    chain_.pop_back();
    return scene;
  }
  static Node objectWithout() {
    Node node;
    node.kind = Node::Kind::object;
    return node;
  }

  std::string name_;
  std::vector<fs::path> chain_;
  std::set<fs::path> seen_;
};

}  // namespace

std::string textOfScene(const fs::path& file, const std::string& where) {
  std::ifstream stream = openFile(file, std::ios::binary);
  if (std::error_code error; fs::is_directory(file, error))
    throw InputError("there is a folder in place of the scene" + (file.string() == where ? "" : ": " + file.string()),
                     where, "give the name of a JSON file in it");
  if (!stream)
    throw InputError("the scene cannot be read" + (file.string() == where ? "" : ": " + file.string()), where,
                     "give the name of a JSON file that you may read");
  std::ostringstream text;
  text << stream.rdbuf();
  return std::string(io::withoutByteOrderMark(text.view(), file.string()));
}

Node withIncludes(Node scene, const std::string& name, const fs::path& folder) {
  Includer includer(name);
  std::error_code error;
  includer.enter(fs::weakly_canonical(name, error));
  return includer.resolve(std::move(scene), folder);
}

}  // namespace dovetail::scene
