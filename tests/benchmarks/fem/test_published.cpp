#include <gtest/gtest.h>

#include "verification_cases.hpp"

namespace dovetail::verification {
namespace {

using fem::ElementShape;
using fem::Formulation;

const ElementKind enhanced{ElementShape::hex8, Formulation::enhanced};
const ElementKind meanDilatation{ElementShape::hex8, Formulation::meanDilatation};
const ElementKind hex20{ElementShape::hex20}, hex27{ElementShape::hex27}, tet10{ElementShape::tet10};

void expectWithin(double value, double reference, double fraction, const std::string& what) {
  EXPECT_NEAR(value / reference, 1.0, fraction) << what;
}

TEST(Published, TheElasticaHasItsTabulatedTip) {
  const double table[][3] = {
      {0.5, 0.16214, 0.01592}, {1.0, 0.30172, 0.05643}, {2.0, 0.49346, 0.16064}, {3.0, 0.60325, 0.25442}};
  for (const auto& [alpha, w, u] : table) {
    const TipOfBeam tip = elastica(alpha);
    EXPECT_NEAR(tip.w, w, 5.1e-6);
    EXPECT_NEAR(tip.u, u, 5.1e-6);
  }
}

TEST(Published, SlenderCantileversFollowTheElastica) {
  for (const ElementKind& kind : {enhanced, hex20, hex27, tet10})
    for (const double alpha : {0.5, 1.0, 2.0, 3.0}) {
      const TipOfBeam tip = bentCantilever(kind, {40, 1}, alpha), exact = elastica(alpha);
      expectWithin(tip.w, exact.w, 1e-3, kind.label());
      expectWithin(tip.u, exact.u, 1e-3, kind.label());
    }
}

TEST(Published, TheBeamBehindTheCylinderHangsAsPublished) {
  const std::pair<ElementKind, std::array<int, 2>> meshes[] = {{enhanced, {40, 4}}, {hex20, {40, 4}}, {hex27, {40, 4}}};
  for (const auto& [kind, cells] : meshes) {
    const Vec3 soft = beamBehindCylinder(kind, cells, 0.5e6), stiff = beamBehindCylinder(kind, cells, 2e6);
    expectWithin(soft.x, -7.18777e-3, 1e-3, kind.label());
    expectWithin(soft.y, -66.1029e-3, 1e-3, kind.label());
    expectWithin(stiff.x, -0.469006e-3, 1e-3, kind.label());
    expectWithin(stiff.y, -16.9740e-3, 1e-3, kind.label());
  }
}

/// Tables of a program for trilinear and triquadratic bricks (Pelteret & McBride 2016), whose faces in z are free.
TEST(Published, CooksMembraneGivesThePublishedTables) {
  const std::pair<int, std::array<double, 2>> table[] = {
      {1, {5.15, 12.19}}, {2, {8.72, 13.83}}, {4, {12.02, 14.22}}, {8, {13.61, 14.30}}};
  for (const auto& [perEdge, tips] : table) {
    EXPECT_NEAR(1e3 * cooksMembrane({ElementShape::hex8}, perEdge, 0.3, Sides::free).tip, tips[0], 0.005) << perEdge;
    EXPECT_NEAR(1e3 * cooksMembrane(hex27, perEdge, 0.3, Sides::free).tip, tips[1], 0.005) << perEdge;
  }
  for (const ElementKind& kind : {enhanced, meanDilatation, hex20})
    EXPECT_NEAR(1e3 * cooksMembrane(kind, 16, 0.3, Sides::free).tip, 14.33, 0.1) << kind.label();
}

/// In plane strain all elements go to one value, here that of hex27 with 32 cells per edge.
TEST(Published, CooksMembraneInPlaneStrainConverges) {
  for (const ElementKind& kind : {enhanced, meanDilatation, hex20, hex27, tet10}) {
    const double error8 = std::abs(1e3 * cooksMembrane(kind, 8, 0.3).tip - 13.773);
    const double error16 = std::abs(1e3 * cooksMembrane(kind, 16, 0.3).tip - 13.773);
    EXPECT_LT(error16, 0.1) << kind.label();
    EXPECT_LT(error16, 0.5 * error8) << kind.label();
  }
}

/// ν = 0.4999. The tip converges to 11.48 mm: that of hex27 with mean dilatation and 16 cells per edge.
TEST(Published, CooksMembraneNearlyIncompressibleNeitherLocksNorAlternates) {
  constexpr double converged = 11.4818e-3;
  const Membrane best = cooksMembrane({ElementShape::hex27, Formulation::meanDilatation}, 8, 0.4999);
  expectWithin(best.tip, converged, 2e-3, "hex27 mean dilatation");
  EXPECT_LT(pressureSteps(best, 12e-3).checkerboard, 0.05);
  const Membrane hex20Means = cooksMembrane({ElementShape::hex20, Formulation::meanDilatation}, 16, 0.4999);
  expectWithin(hex20Means.tip, converged, 1e-2, "hex20 mean dilatation");
  EXPECT_LT(pressureSteps(hex20Means, 12e-3).checkerboard, 0.05);
  expectWithin(cooksMembrane(meanDilatation, 16, 0.4999).tip, converged, 2e-2, "hex8 mean dilatation");
}

}  // namespace
}  // namespace dovetail::verification
