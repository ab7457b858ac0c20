#include "values.hpp"

#include <algorithm>
#include <cctype>

#include "advice.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::scene {

namespace {

std::string textOfLimits(const Limits& limits) {
  const std::string own = siName(limits.dimension), tail = own.empty() ? "" : " " + own;
  std::string text;
  if (std::isfinite(limits.least))
    text = std::string(limits.openBelow ? "above " : "of at least ") + formatNumber(limits.least) + tail;
  if (std::isfinite(limits.most))
    text += std::string(text.empty() ? "" : " and ") + (limits.openAbove ? "below " : "of at most ") +
            formatNumber(limits.most) + tail;
  return text.empty() ? "that is finite" : text;
}

/// Whether evaluate() refuses nothing.
template <class Evaluate>
bool isExpression(const Evaluate& evaluate) {
  try {
    evaluate();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

std::set<std::string> wordsIn(const std::string& expression) {
  const auto isPart = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  std::set<std::string> words;
  for (auto at = expression.begin(); at != expression.end();) {
    const auto end = std::find_if_not(at, expression.end(), isPart);
    words.emplace(at, end);
    at = std::find_if(end, expression.end(), isPart);
  }
  return words;
}

std::string Values::listOf(Words words) {
  std::string list;
  for (const char* const word : words) list += std::string(list.empty() ? "" : ", ") + "\"" + word + "\"";
  return list;
}

std::string Values::placeOf(const Place& place) const {
  const std::string name = placeName(document_.name, place.line == 0 ? absentAt_ : place);
  return path_.empty() ? name : name + ", " + path_;
}

void Values::refuse(const Node& node, const std::string& problem, const std::string& remedy) const {
  throw InputError(problem, placeOf(node.place), remedy);
}

std::optional<Quantity> Values::quantityIn(const std::string& text) const {
  const auto quantity = quantityOf(text);
  if (!quantity || !quantity->joined) return quantity;
  const std::set<std::string> words = wordsIn(text);
  const auto isName = [&](const std::string& word) { return document_.names.contains(word); };
  return std::any_of(words.begin(), words.end(), isName) ? std::nullopt : quantity;
}

std::string Values::textOf(const Node& node, Key key) const {
  if (node.kind != Node::Kind::text || node.text.empty())
    refuse(node, named(key) + " is " + nameOf(node), "write a text in quotes");
  return node.text;
}

std::string Values::wordOf(const Node& node, Key key, Words words) const {
  if (node.kind == Node::Kind::text)
    for (const char* const word : words)
      if (node.text == word) return node.text;
  const std::vector<std::string> names(words.begin(), words.end());
  refuse(node, named(key) + " is " + nameOf(node), adviceFor(node.kind == Node::Kind::text ? node.text : "", names));
}

/// What may be wrong with a text that is no number, before what may be written instead.
std::string Values::guessAt(const std::string& text) const {
  std::string guess;
  for (const std::string& quantity : likelyQuantities(text))
    guess += (guess.empty() ? "write \"" : " or \"") + quantity + "\"";
  if (!guess.empty()) return guess + " if that is meant; ";
  for (const std::string& word : wordsIn(text))
    if (document_.names.contains(word) && !document_.parameters.contains(word))
      return "put the parameter \"" + word + "\" above, as expressions use only parameters above them; ";
  return {};
}

Values::AnyNumber Values::anyNumberOf(const Node& node, Key key, const std::string& otherwise) const {
  if (node.kind == Node::Kind::number) return {node.number, {}};
  const std::string remedy = "write a number, one with a unit (\"5 mm\"), or an expression of parameters" +
                             (otherwise.empty() ? "" : ", or " + otherwise);
  if (node.kind != Node::Kind::text || node.text.empty()) refuse(node, named(key) + " is " + nameOf(node), remedy);
  if (const auto quantity = quantityIn(node.text)) {
    if (quantity->dimension == unit::none) return {quantity->value, {}};
    return {quantity->value, quantity->dimension};
  }
  try {
    return {valueOf(node.text, document_.parameters), {}};
  } catch (const InputError& error) {
    refuse(
        node,
        named(key) + " is " + nameOf(node) + ", which is no number with a unit, and as an expression: " + error.what(),
        guessAt(node.text) + remedy);
  }
}

double Values::numberOf(const Node& node, Key key, const Limits& limits, const std::string& otherwise) const {
  const AnyNumber number = anyNumberOf(node, key, otherwise);
  if (number.dimension && *number.dimension != limits.dimension) {
    const std::string own = siName(limits.dimension);
    refuse(node, named(key) + " is " + nameOf(node) + ", in " + siName(*number.dimension),
           own.empty() ? "write a number without a unit" : "write one in " + own);
  }
  return within(node, key, number.value, limits);
}

double Values::within(const Node& node, Key key, double value, const Limits& limits) const {
  const bool tooSmall = limits.openBelow ? !(value > limits.least) : !(value >= limits.least);
  const bool tooLarge = limits.openAbove ? !(value < limits.most) : !(value <= limits.most);
  if (!std::isfinite(value) || tooSmall || tooLarge)
    refuse(node, named(key) + " is " + formatNumber(value), "write one " + textOfLimits(limits));
  return value;
}

double Values::wholeOf(const Node& node, Key key, double least, double most) const {
  double value = numberOf(node, key, any(unit::none));
  // Expressions such as "width/edge" are whole up to round-off.
  if (node.kind == Node::Kind::text && std::abs(value - std::round(value)) <= 1e-12 * std::abs(value))
    value = std::round(value);
  within(node, key, value, {unit::none, least, most});
  if (value != std::floor(value)) refuse(node, named(key) + " is " + formatNumber(value), "write a whole number");
  return value;
}

TimeValue Values::timeValueOf(const Node& node, Key key, const Limits& limits) {
  // "2*t" is two tonnes where a mass is wanted, and the time doubled elsewhere.
  const auto quantity = node.kind == Node::Kind::text ? quantityIn(node.text) : std::nullopt;
  if (key.ofPlace && node.kind == Node::Kind::text && !quantity)
    for (const std::string& word : wordsIn(node.text))
      if ((word == "x" || word == "y" || word == "z") && document_.names.contains(word))
        refuse(node, named(key) + " is " + nameOf(node) + ", and \"" + word + "\" is both a coordinate and a parameter",
               "give the parameter another name");
  const bool isNumber = node.kind != Node::Kind::text ||
                        (quantity && (quantity->dimension == limits.dimension || quantity->dimension == unit::none));
  if (isNumber || isExpression([&] { valueOf(node.text, document_.parameters); }))
    return {numberOf(node, key, limits), ""};
  try {
    if (key.ofPlace)
      fieldOf(node.text, document_.parameters);
    else
      functionOf(node.text, document_.parameters);
  } catch (const InputError& error) {
    if (quantity) return {numberOf(node, key, limits), ""};  // refused: it has another unit
    refuse(
        node,
        named(key) + " is " + nameOf(node) + ", which is no number with a unit, and as an expression: " + error.what(),
        guessAt(node.text) +
            "write a number, one with a unit (\"5 mm\"), or an expression of parameters and the time t" +
            (key.ofPlace ? " and the place x, y, z" : ""));
  }
  document_.functionsOfTime += node.text + " ";
  return {0.0, node.text};
}

TimeVector Values::timeVectorOf(const Node& node, Key key, const Dimension& dimension) {
  requireThree(node, key);
  TimeVector value;
  for (std::size_t k = 0; k < 3; ++k) value[k] = timeValueOf(node.items[k], key, any(dimension));
  return value;
}

void Values::requireThree(const Node& node, Key key) const {
  if (node.kind != Node::Kind::list || node.items.size() != 3)
    refuse(node, named(key) + " is " + nameOf(node), "write three numbers: [0, 0, 1]");
}

Vec3 Values::vectorOf(const Node& node, Key key, const Dimension& dimension) const {
  requireThree(node, key);
  Vec3 value;
  for (int k = 0; k < 3; ++k) value[k] = numberOf(node.items[static_cast<std::size_t>(k)], key, any(dimension));
  return value;
}

}  // namespace dovetail::scene
