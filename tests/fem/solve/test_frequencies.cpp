// Lowest frequencies against chains that are known exactly, beams and free bodies.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/solve/modes.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

constexpr double young = 1e8, density = 1000.0;

/// A bar of bricks that moves along y only, held at y = 0.
SolidScene barOf(int cells) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {1, cells, 1}, {0, 0, 0}, {0.1, 2.0, 0.1});
  SolidScene bar = sceneOf(mesh, Formulation::standard, StVenantKirchhoff{young, 0.0, density});
  fix(bar.model.nodes, nodeSet(mesh, "skin"), componentX | componentZ);
  fix(bar.model.nodes, nodeSet(mesh, "y-"));
  addMass(bar.model);
  return bar;
}

/// ω h/c of waves cos(k y) in a chain of elements: consistent masses 6 (1 − cos kh)/(2 + cos kh), lumped 2 (1 − cos
/// kh).
TEST(Frequencies, AreThoseOfAChain) {
  constexpr int cells = 12;
  SolidScene bar = barOf(cells);
  for (const double fraction : {0.0, 1.0}) {
    const Modes modes = modesOf(bar.model, {.count = 4, .massFraction = fraction});
    for (int m = 0; m < 4; ++m) {
      const double h = 2.0 / cells, c = std::cos((m + 0.5) * std::numbers::pi / 2.0 * h);
      const double squared = fraction > 0.0 ? 6.0 * (1.0 - c) / (2.0 + c) : 2.0 * (1.0 - c);
      const double exact = std::sqrt(squared * young / density) / h / (2.0 * std::numbers::pi);
      EXPECT_NEAR(modes.frequency[static_cast<std::size_t>(m)] / exact, 1.0, 1e-8) << m << ' ' << fraction;
    }
  }
}

TEST(Frequencies, OfAFreeBodyBeginWithSixRigidMotions) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {2, 3, 2}, {0, 0, 0}, {1.0, 2.0, 1.0});
  SolidScene body = sceneOf(mesh, Formulation::standard, StVenantKirchhoff{young, 0.3, density});
  addMass(body.model);
  const Modes modes = modesOf(body.model, {.count = 8});
  for (std::size_t m = 0; m < 6; ++m) EXPECT_LT(modes.frequency[m], 1e-3 * modes.frequency[6]);
  EXPECT_GT(modes.frequency[6], 1.0);
}

/// Euler and Bernoulli, less a few per mille for shear and rotation.
TEST(Frequencies, OfACantilever) {
  const SolidMesh mesh = boxOf(ElementShape::hex20, {1, 16, 1}, {0, 0, 0}, {0.1, 2.0, 0.05});
  SolidScene beam = sceneOf(mesh, Formulation::standard, StVenantKirchhoff{young, 0.0, density});
  fix(beam.model.nodes, nodeSet(mesh, "y-"));
  addMass(beam.model);
  const Modes modes = modesOf(beam.model, {.count = 3});
  const auto euler = [](double height, double root) {
    return root * root / (2.0 * std::numbers::pi * 4.0) * std::sqrt(young * height * height / (12.0 * density));
  };
  EXPECT_NEAR(modes.frequency[0] / euler(0.05, 1.8751041), 1.0, 3e-3);
  EXPECT_NEAR(modes.frequency[1] / euler(0.1, 1.8751041), 1.0, 1e-2);
  EXPECT_NEAR(modes.frequency[2] / euler(0.05, 4.6940911), 1.0, 1e-2);
  EXPECT_LT(modes.frequency[0], euler(0.05, 1.8751041));
}

/// Tension stiffens, and compression beyond the load of buckling is no state of modes.
TEST(Frequencies, KnowTheStress) {
  const SolidMesh mesh = boxOf(ElementShape::hex20, {1, 16, 1}, {0, 0, 0}, {0.1, 2.0, 0.05});
  const auto first = [&](double traction) {
    SolidScene beam = sceneOf(mesh, Formulation::standard, StVenantKirchhoff{young, 0.0, density});
    fix(beam.model.nodes, nodeSet(mesh, "y-"));
    addMass(beam.model);
    beam.model.add(deadTraction(mesh, faceSet(mesh, "y+"), {0.0, traction, 0.0}));
    solveStatics(beam.model, 0.0);
    return modesOf(beam.model, {.count = 1}).frequency[0];
  };
  // π² E h²/(12 (2 L)²): ω² falls nearly linearly with the load.
  const double buckling = std::numbers::pi * std::numbers::pi * young * 0.05 * 0.05 / (12.0 * 16.0);
  const double free = first(0.0);
  EXPECT_NEAR(std::pow(first(-0.5 * buckling) / free, 2), 0.5, 0.02);
  EXPECT_GT(first(0.5 * buckling), free);
  EXPECT_THROW(first(-1.2 * buckling), NumericalError);
}

TEST(Frequencies, RefuseWhatCannotBe) {
  SolidScene bar = barOf(2);
  EXPECT_THROW(modesOf(bar.model, {.count = 0}), InputError);
  EXPECT_THROW(modesOf(bar.model, {.count = 9}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
