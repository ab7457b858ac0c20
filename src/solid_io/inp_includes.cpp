#include "inp_includes.hpp"

#include <algorithm>

#include "dovetail/io/plain_text.hpp"
#include "inp_cards.hpp"

namespace dovetail::solid_io {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t deepest = 16, mostFiles = 1000, mostBytes = std::size_t{1} << 32;

class Includer {
public:
  explicit Includer(const std::string& deck) : folder_(fs::path(deck).parent_path()) {}

  void add(std::string_view bytes, const std::string& name) {
    std::string room;
    bytes = io::plainText(bytes, name, room);
    std::error_code error;
    chain_.push_back(fs::weakly_canonical(name, error));
    TextSource source(bytes, name);
    InpCards cards(source);
    std::size_t done = source.offset();
    begin(source, name, done);
    while (cards.next()) {
      const bool replaces = cards.keyword() == "include";
      const std::string* const file = fileOf(cards);
      if (file == nullptr) continue;
      take(bytes.substr(done, (replaces ? cards.place() : cards.end()) - done));
      done = cards.end();
      enter(resolve(*file, name, cards), cards);
      begin(source, name, done);
    }
    take(bytes.substr(done));
    chain_.pop_back();
  }

  InpText result;

private:
  static const std::string* fileOf(const InpCards& cards) {
    if (cards.keyword() == "include") {
      cards.requireKnown({{"input"}});
      return &cards.required("input");
    }
    return cards.keyword() == "node" || cards.keyword() == "element" ? cards.parameter("input") : nullptr;
  }

  void begin(const TextSource& source, const std::string& name, std::size_t at) {
    result.pieces.push_back({result.text.size(), name, source.lineAt(at)});
  }
  void take(std::string_view part) {
    result.text += part;
    if (!result.text.empty() && result.text.back() != '\n') result.text += '\n';
  }

  fs::path resolve(std::string file, const std::string& from, const InpCards& cards) const {
    std::replace(file.begin(), file.end(), '\\', '/');
    std::error_code error;
    for (const fs::path& folder : {folder_, fs::path(from).parent_path()})
      if (fs::is_regular_file(folder / file, error)) return folder / file;
    cards.refuse("there is no file " + shown(file) + " for *" + cards.keyword(),
                 "give its name relative to the folder of the deck");
  }

  void enter(const fs::path& file, const InpCards& cards) {
    std::error_code error;
    if (std::find(chain_.begin(), chain_.end(), fs::weakly_canonical(file, error)) != chain_.end())
      cards.refuse(file.string() + " includes itself", "leave the card out");
    if (chain_.size() > deepest) cards.refuse("files are included more than 16 deep", "write them into fewer files");
    if (++files_ > mostFiles) cards.refuse("more than 1000 files are included", "write them into fewer files");
    const std::string bytes = io::readWhole(file, "a mesh");
    if (result.text.size() + bytes.size() > mostBytes)
      cards.refuse("the included files have more than 4 GiB", "include each of them once");
    add(bytes, file.string());
  }

  fs::path folder_;
  std::vector<fs::path> chain_;
  std::size_t files_ = 0;
};

}  // namespace

InpText withIncludes(std::string_view bytes, const std::string& name) {
  Includer includer(name);
  includer.add(bytes, name);
  return std::move(includer.result);
}

}  // namespace dovetail::solid_io
