// Which element has a face with given corners.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::solid_io {

/// Face `side` (fem::localFacesOf) of an element.
struct Side {
  int element, side;
};

class FaceFinder {
public:
  explicit FaceFinder(const fem::SolidMesh& mesh);
  /// Of two elements that share the face, the one from whose outside the corners run counter-clockwise (of lines:
  /// around which they do); of one, that one. element = −1 if there is none.
  /// @param corners  3 or 4 node numbers in order around the face, or 2 along a line
  Side find(std::span<const int> corners) const;
  fem::Face face(const Side& side) const;

private:
  struct Entry {
    std::array<int, 4> key;  // sorted corners
    Side side;
  };
  const fem::SolidMesh& mesh_;
  std::vector<Entry> entries_;
};

}  // namespace dovetail::solid_io
