// Ends with 0 if the room geometry, built inside another project, answers.
#include "dovetail/geometry/lattice.hpp"

int main() {
  const dovetail::geometry::Lattice lattice{
      {dovetail::Vec3{2, 0, 0}, dovetail::Vec3{1, 3, 0}, dovetail::Vec3{0, 0, 5}}};
  return lattice.volume() == 30.0 ? 0 : 1;
}
