#include "../core/every_vector_code.hpp"
#include "cells.hpp"

namespace dovetail::rve {
namespace {

/// All that a cell is like after some steps of shear.
std::vector<double> numbersAfterSteps(Rve cell) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G(0, 1) = 1e-4;
  for (int k = 0; k < 30; ++k) step(cell, 0.5 * cell.state.criticalStep, G, 0.3);
  const CellState& s = cell.state;
  std::vector<double> all{s.ledger.work, s.ledger.friction, s.ledger.damping, s.remainingSkin, s.criticalStep};
  for (const Components* field : {&s.x, &s.v, &s.spin, &s.force, &s.torque, &s.contacts.stretch})
    for (const std::vector<double>& component : *field) all.insert(all.end(), component.begin(), component.end());
  for (int k = 0; k < 9; ++k) all.push_back(s.virial(k));
  return all;
}

TEST(VectorCode, CellsHaveTheSameDigits) {
  Rve rolling = pressedDiscs(60), elastic = pressedSpheres(48);
  Springs springs = rolling.springs;
  springs.rolling = 0.5;
  springs.rollingLimit = 0.1;
  setSprings(rolling, springs);
  setSprings(elastic, hertzMindlin(29e7, 0.15, 0.5));
  for (const Rve& cell : {pressedDiscs(60), rolling, pressedSpheres(48), elastic})
    test::expectSameDigitsOfEveryVectorCode("cell", [&] { return numbersAfterSteps(cell); });
}

}  // namespace
}  // namespace dovetail::rve
