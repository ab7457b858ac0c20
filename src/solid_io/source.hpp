// Text and binary numbers of a file, with the place at hand for errors.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dovetail/io/plain_text.hpp"

namespace dovetail::solid_io {

using io::lower;
using io::shown;
std::string_view trimmed(std::string_view text);

/// A file's bytes, and a place in them. Numbers are words between blanks, or bytes where `binary` is set.
class Source {
public:
  /// @throws InputError for a text in UTF-16
  Source(std::string_view bytes, std::string name);

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
  std::size_t remaining() const { return bytes_.size() - at_; }
  bool atEnd() const { return at_ >= bytes_.size(); }

  /// The rest of this line without its end, and on to the next line.
  std::string_view line();
  /// The next word on whatever line; empty at the end.
  std::string_view word();
  /// Passes over the rest of the line.
  void endLine();
  /// A whole number: the next word, or `size` bytes.
  std::int64_t integer(std::size_t size);
  double real();
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
  std::string_view take(std::size_t size);

  std::string_view bytes_;
  std::string name_;
  std::size_t at_ = 0, last_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace dovetail::solid_io
