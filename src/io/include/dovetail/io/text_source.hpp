// Text and binary numbers of a file, with the place at hand for errors.
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dovetail/io/plain_text.hpp"

namespace dovetail::io {

std::string_view trimmed(std::string_view text);

/// Whether the whole word is a number of the type; a leading + is taken.
template <class Number>
bool isNumber(std::string_view word, Number& value) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

/// A file's bytes, and a place in them. Numbers are words between blanks, or bytes where `binary` is set.
class TextSource {
public:
  /// @param bytes  of a plainText, or of a file with binary parts; they must outlive this
  TextSource(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  /// From `begin` on lines are those of another file.
  struct Piece {
    std::size_t begin;
    std::string file;
    std::size_t line;  ///< of its first, from 1
  };
  /// In the order of `begin`.
  void setPieces(std::vector<Piece> pieces) { pieces_ = std::move(pieces); }

  bool binary = false;
  enum class Places { lines, bytes, none };
  Places places = Places::lines;  ///< what errors name

  std::size_t offset() const { return at_; }
  void goTo(std::size_t offset) { at_ = offset; }
  std::size_t remaining() const { return bytes_.size() - at_; }
  bool atEnd() const { return at_ >= bytes_.size(); }

  /// The rest of this line without its end, and on to the next line.
  std::string_view line();
  /// The next word on whatever line; empty at the end.
  std::string_view word();
  /// The next word of this line; empty at its end.
  std::string_view wordOnLine();
  /// Passes over the rest of the line.
  void endLine();
  /// A whole number: the next word, or `size` bytes.
  std::int64_t integer(std::size_t size);
  double real();
  /// So many bytes. @throws InputError if they are not there
  std::string_view take(std::size_t size);
  /// A count of things that take at least `bytesEach` bytes; one that the file cannot hold is refused.
  std::size_t count(std::size_t size, std::size_t bytesEach);
  /// Goes behind the next line that is `text`; refuses if there is none.
  void skipBehindLine(const std::string& text);

  std::int64_t parseInteger(std::string_view word) const;
  double parseReal(std::string_view word) const;

  /// @throws InputError naming the line (the byte, in binary parts) of the given place, by default of the last word
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const {
    refuseAt(last_, problem, remedy);
  }
  [[noreturn]] void refuseAt(std::size_t offset, const std::string& problem, const std::string& remedy) const;
  std::size_t lineAt(std::size_t offset) const;
  const std::string& name() const { return name_; }

private:
  std::string_view bytes_;
  std::string name_;
  std::size_t at_ = 0, last_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace dovetail::io
