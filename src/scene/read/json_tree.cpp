#include "json_tree.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::scene {

namespace {

constexpr std::size_t deepest = 64;

/// Where lines begin.
std::vector<std::size_t> lineStarts(const std::string& text) {
  std::vector<std::size_t> starts{0};
  for (std::size_t k = 0; k < text.size(); ++k)
    if (text[k] == '\n') starts.push_back(k + 1);
  return starts;
}

Place placeAt(const std::vector<std::size_t>& starts, std::size_t offset) {
  const auto line = std::upper_bound(starts.begin(), starts.end(), offset) - starts.begin();
  return {static_cast<int>(line), 1 + static_cast<int>(offset - starts[static_cast<std::size_t>(line - 1)]), nullptr};
}

/// Characters of the text, counted as the parser takes them.
struct Cursor {
  using difference_type = std::ptrdiff_t;
  using value_type = char;
  using pointer = const char*;
  using reference = const char&;
  using iterator_category = std::input_iterator_tag;
  const char* at = nullptr;
  const char** last = nullptr;
  reference operator*() const { return *at; }
  Cursor& operator++() {
    *last = ++at;
    return *this;
  }
  Cursor operator++(int) {
    Cursor before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const Cursor& a, const Cursor& b) { return a.at == b.at; }
};

/// Makes nodes of the parser's events. Events come when their token has just been taken, a number with the character
/// behind it.
class Builder {
public:
  Builder(const std::string& text, const std::string& name)
      : text_(text), name_(name), starts_(lineStarts(text)), taken_(text.data()) {
    open_.push_back(&root_);
  }
  const char** taken() { return &taken_; }
  Node take() { return root_.items.empty() ? Node{} : std::move(root_.items[0]); }

  bool null() { return add({}); }
  bool boolean(bool value) {
    Node node;
    node.kind = Node::Kind::boolean;
    node.boolean = value;
    return add(std::move(node));
  }
  bool number_integer(std::int64_t value) { return number(static_cast<double>(value), true); }
  bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value), true); }
  bool number_float(double value, const std::string&) { return number(value, false); }
  bool string(std::string& value) {
    requirePrintable(value);
    Node node;
    node.kind = Node::Kind::text;
    node.text = value;
    return add(std::move(node));
  }
  bool binary(nlohmann::json::binary_t&) { return false; }
  bool start_object(std::size_t) { return start(Node::Kind::object); }
  bool start_array(std::size_t) { return start(Node::Kind::list); }
  bool end_object() { return end(); }
  bool end_array() { return end(); }
  bool key(std::string& value) {
    requirePrintable(value);
    const Place place = placeOfToken(true);
    if (open_.back()->find(value))
      throw InputError("the key \"" + value + "\" is there twice", placeName(name_, place), "leave one of them out");
    open_.back()->members.push_back({value, place, {}});
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) {
    std::string why = error.what();
    if (const auto at = why.find("column "); at != std::string::npos)
      if (const auto colon = why.find(": ", at); colon != std::string::npos) why = why.substr(colon + 2);
    std::replace(why.begin(), why.end(), '\n', ' ');
    constexpr const char* lastRead = "last read: '";
    if (const auto at = why.find(lastRead); at != std::string::npos && why.size() > at + 60)
      why = why.substr(0, at) + lastRead + "…" + why.substr(why.size() - 40);
    const Place place = placeAt(starts_, position == 0 ? 0 : position - 1);
    throw InputError("this is no JSON: " + why, placeName(name_, place), "correct it there or just before");
  }

private:
  bool number(double value, bool whole) {
    Node node;
    node.kind = Node::Kind::number;
    node.number = value;
    node.whole = whole;
    return add(std::move(node));
  }
  bool start(Node::Kind kind) {
    if (open_.size() > deepest)
      throw InputError("more than 64 levels of brackets", placeName(name_, placeOfToken(false)), "leave levels out");
    Node node;
    node.kind = kind;
    add(std::move(node));
    Node& holder = *open_.back();
    open_.push_back(holder.kind == Node::Kind::object ? &holder.members.back().value[0] : &holder.items.back());
    return true;
  }
  bool end() {
    open_.pop_back();
    return true;
  }
  bool add(Node node) {
    node.place = placeOfToken(node.kind == Node::Kind::text);
    Node& holder = *open_.back();
    if (holder.kind == Node::Kind::object)
      holder.members.back().value.push_back(std::move(node));
    else
      holder.items.push_back(std::move(node));
    return true;
  }
  /// Texts go into messages, names of files and expressions.
  void requirePrintable(const std::string& text) const {
    if (std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }))
      throw InputError("a text holds a line break or another control character", placeName(name_, placeOfToken(true)),
                       "leave it out");
  }
  Place placeOfToken(bool quoted) const {
    auto end = static_cast<std::size_t>(taken_ - text_.data());
    const auto isWord = [&](std::size_t k) {
      return std::string_view("+-.").find(text_[k]) != std::string::npos ||
             std::isalnum(static_cast<unsigned char>(text_[k]));
    };
    if (quoted) {
      std::size_t begin = end - 1;
      while (begin > 0 && (text_[begin - 1] != '"' || (begin > 1 && text_[begin - 2] == '\\'))) --begin;
      return placeAt(starts_, begin == 0 ? 0 : begin - 1);
    }
    if (end > 0 && (text_[end - 1] == '{' || text_[end - 1] == '[')) return placeAt(starts_, end - 1);
    if (end > 0 && !isWord(end - 1)) --end;
    while (end > 0 && isWord(end - 1)) --end;
    return placeAt(starts_, end);
  }

  const std::string &text_, &name_;
  const std::vector<std::size_t> starts_;
  const char* taken_;
  Node root_;
  std::vector<Node*> open_;
};

}  // namespace

const Node* Node::find(const std::string& key) const {
  for (const Member& member : members)
    if (member.key == key) return member.value.empty() ? this : &member.value[0];
  return nullptr;
}
Node* Node::find(const std::string& key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

std::string nameOf(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "null";
    case Node::Kind::boolean:
      return node.boolean ? "true" : "false";
    case Node::Kind::number:
      return "the number " + formatNumber(node.number);
    case Node::Kind::text:
      return "the text \"" + (node.text.size() > 60 ? node.text.substr(0, 60) + "…" : node.text) + "\"";
    case Node::Kind::list:
      return "a list of " + std::to_string(node.items.size());
    case Node::Kind::object:
      return "an object";
  }
  return "";
}

std::string placeName(const std::string& name, const Place& place) {
  if (place.line == 0) return name;
  return (place.file ? place.file->string() : name) + ":" + std::to_string(place.line) + ":" +
         std::to_string(place.column);
}

Node parseJson(const std::string& text, const std::string& name) {
  Builder builder(text, name);
  const char* ignored = nullptr;
  nlohmann::json::sax_parse(Cursor{text.data(), builder.taken()}, Cursor{text.data() + text.size(), &ignored}, &builder,
                            nlohmann::json::input_format_t::json, true, true);
  return builder.take();
}

}  // namespace dovetail::scene
