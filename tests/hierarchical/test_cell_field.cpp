#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "solids_of_cells.hpp"

namespace dovetail::hierarchical {
namespace {

using rve::plane;

/// One cell whose contacts never slip, so that its answer has a derivative.
rve::Rve stickingCell() {
  rve::Rve cell = threeCells()[1];
  rve::Springs sticking = cell.springs;
  sticking.friction = std::numeric_limits<double>::infinity();
  rve::setSprings(cell, sticking);
  return cell;
}

TEST(CellField, AnswersAreThoseOfTheCell) {
  const QuasiStaticCells settings;
  Asked asked(cellField(oneCell(), settings));
  rve::Rve cell = threeCells()[0];
  for (const Eigen::Matrix3d& F : {plane(0.9995, 0, 0, 1.0002), plane(0.999, 4e-4, 0, 1.001)}) {
    const double stored = rve::storedEnergy(cell), work = cell.state.ledger.work;
    const Eigen::Matrix3d P = asked(F);
    asked.field().commit();
    relax(cell, F, settings);
    EXPECT_EQ(P, rve::nominalStress(cell));
    EXPECT_LE(rve::balance(cell).unbalanced, settings.unbalanced);
    EXPECT_EQ(asked.energy[0], rve::storedEnergy(cell) / cell.volume);
    const double gone = (cell.state.ledger.work - work - (rve::storedEnergy(cell) - stored)) / cell.volume;
    EXPECT_NEAR(asked.dissipated[0], gone, 0.01 * (std::abs(cell.state.ledger.work - work) / cell.volume));
    EXPECT_GT(asked.dissipated[0], 0.0);
  }
}

TEST(CellField, TangentIsTheDerivativeOfTheAnswer) {
  const rve::Rve cell = stickingCell();
  Asked asked(cellField({cell}, QuasiStaticCells{.unbalanced = 1e-10}));
  const Eigen::Matrix3d F = plane(1.0005, 4e-4, -3e-4, 0.999);
  asked(F);
  asked.field().commit();
  const rve::Tangent A = asked.tangentAt(F);
  const double h = 1e-7;
  rve::Tangent slope = rve::Tangent::Zero();
  for (int k = 0; k < 2; ++k)
    for (int L = 0; L < 2; ++L) {
      Eigen::Matrix3d more = F, less = F;
      more(k, L) += h;
      less(k, L) -= h;
      const RowMajor column = (asked(more) - asked(less)) / (2.0 * h);
      slope.col(3 * k + L) = Eigen::Map<const Eigen::Vector<double, 9>>(column.data());
    }
  EXPECT_LT((A - slope).norm(), 1e-4 * A.norm());
}

TEST(CellField, EveryAnswerStartsFromTheCommittedCell) {
  const Eigen::Matrix3d there = plane(0.998, 0, 0, 1.002), here = plane(0.999, 0, 0, 1.0);
  Asked straight(cellField(oneCell())), round(cellField(oneCell()));
  round(there);
  EXPECT_EQ(round(here), straight(here));
  round(there);
  round.field().revert();
  EXPECT_EQ(round(here), straight(here));
  round(there);
  round.field().commit();
  straight(here);
  straight.field().commit();
  EXPECT_NE(round(here), straight(here));  // grains have slipped
}

TEST(CellField, ACommittedCellStaysAsItIs) {
  Asked asked(cellField(oneCell()));
  const Eigen::Matrix3d F = plane(0.999, 0, 0, 1.0);
  const Eigen::Matrix3d P = asked(F);
  for (int k = 0; k < 3; ++k) {
    asked.field().commit();
    EXPECT_EQ(asked(F), P);
    EXPECT_EQ(asked.dissipated[0], 0.0);
  }
}

TEST(CellField, TurnedCellsPressAsBefore) {
  for (const auto& samples : {oneCell(), std::vector<rve::Rve>{rve::pressedSpheres(64)}}) {
    Asked asked(cellField(samples));
    const Eigen::Matrix3d F = plane(0.999, 3e-4, 0, 1.0), R = rve::turned(20.0 / 180.0 * std::numbers::pi);
    const Eigen::Matrix3d P = asked(F);
    const double stored = asked.energy[0];
    asked.field().commit();
    EXPECT_LT((asked(R * F) - R * P).norm(), 1e-12 * P.norm());
    EXPECT_EQ(asked.reason[0], "");
    EXPECT_NEAR(asked.energy[0], stored, 1e-12 * stored);
    EXPECT_NEAR(asked.dissipated[0], 0.0, 1e-12 * stored);
  }
}

TEST(CellField, PointsBeginAsTheCellsOfTheBankInTurn) {
  Asked asked(cellField(threeCells()), 4);
  const Eigen::Matrix3d F = plane(0.999, 0, 0, 1.0);
  asked(F);
  EXPECT_NE(matrixAt(asked.P, 0), matrixAt(asked.P, 1));
  EXPECT_NE(matrixAt(asked.P, 1), matrixAt(asked.P, 2));
  EXPECT_EQ(matrixAt(asked.P, 0), matrixAt(asked.P, 3));
}

TEST(CellField, SpheresPressAcrossThePlane) {
  Asked asked(cellField({rve::pressedSpheres(64)}));
  const Eigen::Matrix3d P = asked(plane(0.999, 0, 0, 1.0));
  EXPECT_LT(P(2, 2), -1e6);
  EXPECT_LT(P(0, 0), P(2, 2));
}

TEST(CellField, StatesGoThroughBytesAndThoseOfOtherCellsAreRefused) {
  Asked first(cellField(threeCells()), 3), second(cellField(threeCells()), 3);
  first(plane(0.999, 3e-4, 0, 1.0));
  first.field().commit();
  ByteWriter archive;
  first.field().save(archive);
  ByteReader bytes(archive.bytes());
  second.field().load(bytes);
  EXPECT_TRUE(bytes.atEnd());
  const Eigen::Matrix3d F = plane(0.998, 6e-4, 0, 1.0);
  EXPECT_EQ(first(F), second(F));
  EXPECT_EQ(first.P, second.P);

  Asked others(cellField({rve::pressedDiscs(60, 4)}), 3);
  ByteReader again(archive.bytes());
  EXPECT_THROW(others.field().load(again), InputError);
  for (std::size_t spoilt = 40; spoilt < archive.bytes().size(); spoilt += 997) {
    std::vector<char> damaged = archive.bytes();
    for (std::size_t k = spoilt; k < std::min(spoilt + 8, damaged.size()); ++k) damaged[k] = '\xff';
    ByteReader read(damaged);
    try {  // what a double is may be any double; all else must be noticed
      second.field().load(read);
    } catch (const InputError&) {
    }
  }
}

void expectReason(Asked& asked, const Eigen::Matrix3d& F, const std::string& part) {
  asked(F);
  EXPECT_NE(asked.reason[0].find(part), std::string::npos) << asked.reason[0];
}

TEST(CellField, WhatACellCannotAnswerIsSaid) {
  Asked asked(cellField(oneCell()));
  expectReason(asked, plane(0.9, 0, 0, 1.0), "in steps of at most 0.05");
  expectReason(asked, plane(-1.0, 0, 0, 1.0), "determinant");
  expectReason(asked, plane(1.03, 0, 0, 1.03), "no grains touch");
  Eigen::Matrix3d outward = plane(1, 0, 0, 1);
  outward(2, 2) = 1.001;
  expectReason(asked, outward, "meanDilatation");
  Asked hurried(cellField(oneCell(), QuasiStaticCells{.path = {.rest = {.steps = 1}}}));
  expectReason(hurried, plane(0.99, 0, 0, 1.0), "out of balance");
  EXPECT_NO_THROW(asked(plane(0.999, 0, 0, 1.0)));
  EXPECT_EQ(asked.reason[0], "");
}

TEST(CellField, WrongBanksAndSettingsAreRefused) {
  EXPECT_THROW(cellField({}), InputError);
  rve::Rve other = threeCells()[1];
  rve::Springs springs = other.springs;
  springs.modulus *= 2.0;
  rve::setSprings(other, springs);
  EXPECT_THROW(cellField({threeCells()[0], other}), InputError);
  rve::Rve deformed = threeCells()[0];
  relax(deformed, plane(0.999, 0, 0, 1.0), {});
  EXPECT_THROW(cellField({deformed}), InputError);
  rve::Rve pushed = threeCells()[0];
  rve::displace(pushed, rve::scaled(pushed.state.force, 1e-9), rve::scaled(pushed.state.torque, 0.0));
  pushed.state.v[0][0] = 1e-3;
  EXPECT_THROW(cellField({pushed}), InputError);
  EXPECT_THROW(cellField({rve::randomCell({.count = 40}, rve::ordinarySprings())}), InputError);
  for (const double unbalanced : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(cellField(oneCell(), QuasiStaticCells{.unbalanced = unbalanced}), InputError);
  EXPECT_THROW(cellField(oneCell(), QuasiStaticCells{.path = {.inertialNumber = 0.1}}), InputError);
  EXPECT_THROW(cellField(oneCell(), QuasiStaticCells{.path = {.rest = {.steps = 0}}}), InputError);
  EXPECT_THROW(cellField(oneCell(), DynamicCells{.strainPerStep = 0.0}), InputError);
  EXPECT_THROW(cellField(oneCell(), DynamicCells{.damping = 1.0}), InputError);
  EXPECT_THROW(cellField(oneCell(), DynamicCells{.stepFraction = 1.0}), InputError);
}

TEST(CellField, SmallCellsAreMarked) {
  EXPECT_NE(cellField(oneCell())->name().find("fewer than 100 grains"), std::string::npos);
  const rve::Rve cell = rve::pressedDiscs(120);
  EXPECT_EQ(whySmall(cell), "");
  EXPECT_EQ(cellField({cell})->name(), "cells of 120 discs");
}

}  // namespace
}  // namespace dovetail::hierarchical
