#include "text_scanner.hpp"

#include <charconv>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/farthest.hpp"

namespace dovetail::mesh_io {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

template <class Value>
bool parse(std::string_view word, Value& value) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  return result.ec == std::errc{} && result.ptr == word.data() + word.size();
}

}  // namespace

std::string readWhole(const std::filesystem::path& path) {
  std::string bytes = io::readWhole(path, "a surface");
  if (bytes.empty()) throw InputError("the file is empty", path.string(), "give a file with a surface");
  return bytes;
}

std::string plainText(std::string bytes, const std::filesystem::path& path) {
  if (const std::size_t mark = bytes.size() - io::withoutByteOrderMark(bytes, path.string()).size(); mark > 0)
    bytes.erase(0, mark);
  bytes.resize(io::withoutEndMark(bytes).size());
  io::endLinesWithLf(bytes);
  return bytes;
}

void refuse(const std::filesystem::path& path, const std::string& place, const std::string& problem,
            const std::string& remedy) {
  throw InputError(problem, place.empty() ? path.string() : path.string() + ", " + place, remedy);
}

void requireFacets(const geometry::TriangleMesh& mesh, const std::filesystem::path& path) {
  if (mesh.facets.empty()) refuse(path, "", "the file holds no facets", "give a file with a surface of triangles");
  if (mesh.x.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    refuse(path, "", "the file holds too many vertices", "cut the surface into several files");
  for (std::size_t v = 0; v < mesh.x.size(); ++v)
    if (isTooFar(mesh.x[v]))
      refuse(path, "vertex " + std::to_string(v), "it lies farther than 1e15 m from the origin",
             "give coordinates in metres");
}

void addFan(const std::vector<int>& corners, geometry::TriangleMesh& mesh) {
  for (std::size_t k = 2; k < corners.size(); ++k) mesh.facets.push_back({corners[0], corners[k - 1], corners[k]});
}

std::string_view TextScanner::wordOnLine() {
  while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
  const std::size_t begin = at_;
  while (at_ < text_.size() && !isBlank(text_[at_]) && text_[at_] != '\n') ++at_;
  return text_.substr(begin, at_ - begin);
}

std::string_view TextScanner::word() {
  std::string_view found = wordOnLine();
  while (found.empty() && nextLine()) found = wordOnLine();
  return found;
}

bool TextScanner::nextLine() {
  at_ = text_.find('\n', at_);
  if (at_ == std::string_view::npos || at_ + 1 >= text_.size()) {
    at_ = text_.size();
    return false;
  }
  ++at_;
  ++line_;
  return true;
}

double TextScanner::number(std::string_view word) const {
  double value = 0.0;
  if (!parse(word, value)) refuse(shown(word) + " is not a number", "write a number such as 1.5e-3");
  if (!std::isfinite(value)) refuse("a coordinate is " + shown(word), "give finite numbers");
  return value;
}

int TextScanner::integer(std::string_view word) const {
  int value = 0;
  if (!parse(word, value)) refuse(shown(word) + " is not a whole number", "write one such as 12");
  return value;
}

void TextScanner::refuse(const std::string& problem, const std::string& remedy) const {
  mesh_io::refuse(*path_, "line " + std::to_string(line_), problem, remedy);
}

std::optional<double> numberIn(std::string_view word) {
  double value = 0.0;
  return parse(word, value) ? std::optional(value) : std::nullopt;
}

}  // namespace dovetail::mesh_io
