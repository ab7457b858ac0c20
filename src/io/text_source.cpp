#include "dovetail/io/text_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "dovetail/core/error.hpp"

namespace dovetail::io {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == '\n'; }

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view TextSource::line() {
  last_ = at_;
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  const std::string_view text = bytes_.substr(at_, end - at_);
  at_ = std::min(end + 1, bytes_.size());
  return text;
}

std::string_view TextSource::wordOnLine() {
  while (at_ < bytes_.size() && isBlank(bytes_[at_]) && bytes_[at_] != '\n') ++at_;
  last_ = at_;
  while (at_ < bytes_.size() && !isBlank(bytes_[at_])) ++at_;
  return bytes_.substr(last_, at_ - last_);
}

std::string_view TextSource::word() {
  while (at_ < bytes_.size() && isBlank(bytes_[at_])) ++at_;
  return wordOnLine();
}

void TextSource::endLine() { at_ = std::min(std::min(bytes_.find('\n', at_), bytes_.size()) + 1, bytes_.size()); }

std::string_view TextSource::take(std::size_t size) {
  last_ = at_;
  if (remaining() < size) refuse("the file breaks off", "give a complete file");
  at_ += size;
  return bytes_.substr(last_, size);
}

std::int64_t TextSource::integer(std::size_t size) {
  if (!binary) return parseInteger(word());
  if (size == 4) {
    std::int32_t value = 0;
    std::memcpy(&value, take(4).data(), 4);
    return value;
  }
  std::int64_t value = 0;
  std::memcpy(&value, take(8).data(), 8);
  return value;
}

double TextSource::real() {
  if (!binary) return parseReal(word());
  double value = 0.0;
  std::memcpy(&value, take(8).data(), 8);
  if (!std::isfinite(value)) refuse("a number is NaN or infinite", "give finite numbers");
  return value;
}

std::size_t TextSource::count(std::size_t size, std::size_t bytesEach) {
  const std::int64_t value = integer(size);
  if (value < 0 || static_cast<std::uint64_t>(value) > remaining() / bytesEach)
    refuse("it announces " + std::to_string(value) + " entries, which the rest of the file cannot hold",
           "give a complete file");
  return static_cast<std::size_t>(value);
}

void TextSource::skipBehindLine(const std::string& text) {
  const std::size_t begin = at_;
  for (std::size_t at = bytes_.find(text, at_); at != std::string_view::npos; at = bytes_.find(text, at + 1)) {
    const std::size_t end = at + text.size();
    const bool starts = at == 0 || bytes_[at - 1] == '\n', ends = end >= bytes_.size() || isBlank(bytes_[end]);
    if (!starts || !ends) continue;
    at_ = end;
    endLine();
    return;
  }
  refuseAt(begin, "there is no line " + text + " after this", "give a complete file");
}

std::int64_t TextSource::parseInteger(std::string_view word) const {
  std::int64_t value = 0;
  if (word.empty() && atEnd()) refuse("the file breaks off where a whole number should be", "give a complete file");
  if (!isNumber(word, value)) refuse(shown(word) + " is not a whole number", "write one such as 12");
  return value;
}

double TextSource::parseReal(std::string_view word) const {
  if (word.empty() && atEnd()) refuse("the file breaks off where a number should be", "give a complete file");
  double value = 0.0;
  std::string fortran;
  if (const std::size_t d = word.find_first_of("dD"); d != std::string_view::npos) {  // 1.5D-3
    fortran = std::string(word);
    fortran[d] = 'e';
    word = fortran;
  }
  if (!isNumber(word, value)) refuse(shown(word) + " is not a number", "write a number such as 1.5e-3");
  if (!std::isfinite(value)) refuse("a number is " + shown(word), "give finite numbers");
  return value;
}

std::size_t TextSource::lineAt(std::size_t offset) const {
  const std::string_view before = bytes_.substr(0, std::min(offset, bytes_.size()));
  return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

void TextSource::refuseAt(std::size_t offset, const std::string& problem, const std::string& remedy) const {
  if (places == Places::none) throw InputError(problem, name_, remedy);
  if (binary || places == Places::bytes) throw InputError(problem, name_ + ", byte " + std::to_string(offset), remedy);
  Piece piece{0, name_, 1};
  for (const Piece& one : pieces_)
    if (one.begin <= offset) piece = one;
  const std::size_t line = piece.line + lineAt(offset) - lineAt(piece.begin);
  throw InputError(problem, piece.file + ", line " + std::to_string(line), remedy);
}

}  // namespace dovetail::io
