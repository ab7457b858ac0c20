#include "../core/every_vector_code.hpp"
#include "cells.hpp"

namespace dovetail::rve {
namespace {

/// All that a cell is like after some steps of shear.
std::vector<double> numbersAfterSteps(Cell cell) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G(0, 1) = 1e-4;
  for (int k = 0; k < 30; ++k) step(cell, 0.5 * cell.state.criticalStep, G, 0.3);
  const CellState& s = cell.state;
  std::vector<double> all{s.book.work, s.book.friction, s.book.damping, s.room, s.criticalStep};
  for (const Components* field : {&s.x, &s.v, &s.spin, &s.force, &s.torque, &s.contacts.stretch})
    for (const std::vector<double>& component : *field) all.insert(all.end(), component.begin(), component.end());
  for (int k = 0; k < 9; ++k) all.push_back(s.dyad(k));
  return all;
}

TEST(VectorCode, CellsHaveTheSameDigits) {
  Cell rolling = pressedDiscs(60);
  Springs springs = rolling.springs;
  springs.rolling = 0.5;
  springs.rollingLimit = 0.1;
  setSprings(rolling, springs);
  for (const Cell& cell : {pressedDiscs(60), rolling, pressedSpheres(48)})
    test::expectSameDigitsOfEveryVectorCode("cell", [&] { return numbersAfterSteps(cell); });
}

}  // namespace
}  // namespace dovetail::rve
