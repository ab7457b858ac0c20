// Text and bytes of a file, with the place at hand for errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/io/plain_text.hpp"

namespace dovetail::mesh_io {

/// @throws InputError if it is no file, cannot be read, or is empty
std::string readWhole(const std::filesystem::path& path);

/// A text without a byte-order mark and an end mark, its lines ending with LF.
/// @throws InputError for a text in UTF-16
std::string plainText(std::string bytes, const std::filesystem::path& path);

/// @throws InputError
[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& place, const std::string& problem,
                         const std::string& remedy);

/// What the last step of every reader makes sure of.
/// @throws InputError if there are no facets, more vertices than int can count, or one farther than 1e15 m from the
///         origin
void requireFacets(const geometry::TriangleMesh& mesh, const std::filesystem::path& path);

/// Appends a fan around the first corner.
void addFan(const std::vector<int>& corners, geometry::TriangleMesh& mesh);

/// Words between blanks, line by line.
class TextScanner {
public:
  TextScanner(std::string_view text, const std::filesystem::path& path, std::size_t line = 1)
      : text_(text), path_(&path), line_(line) {}

  /// The next word of this line; empty at its end.
  std::string_view wordOnLine();
  /// The next word, on whatever line; empty at the end of the text.
  std::string_view word();
  /// Passes over the rest of the line; false at the end of the text.
  bool nextLine();
  bool atEnd() const { return at_ >= text_.size(); }
  std::size_t offset() const { return at_; }
  /// What follows on this line.
  std::string_view restOfLine() const { return text_.substr(at_, text_.find('\n', at_) - at_); }

  /// @throws InputError unless the word is a number with a finite value (a leading + is taken)
  double number(std::string_view word) const;
  /// @throws InputError unless the word is a whole number that int can hold
  int integer(std::string_view word) const;
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const;

private:
  std::string_view text_;
  const std::filesystem::path* path_;
  std::size_t at_ = 0, line_;
};

using io::lower;
using io::shown;

/// The value of a word, NaN and infinity included; none if it is no number.
std::optional<double> numberIn(std::string_view word);

}  // namespace dovetail::mesh_io
