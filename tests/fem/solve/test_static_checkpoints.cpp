#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/model/checkpoint.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

/// A block with plastic strain, enhanced modes and friction, pressed on a plane and dragged along it.
Model pressedBlock() {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {2, 1, 2}, {}, {0.2, 0.1, 0.1});
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(J2Plasticity{1e7, 0.3, 1000.0, linearYield(2e4, 1e5)}),
                      {.formulation = Formulation::enhanced}));
  ContactOptions contact;
  contact.penalty = 1e9;
  contact.friction = 0.3;
  model.add(makeContactPlane(mesh, faceSet(mesh, "z-"), {{}, {0, 0, 1}, {}}, contact));
  const std::vector<int> top = nodeSet(mesh, "z+");
  model.constraints.prescribe(top, 2, [](double t) { return -2e-3 * t; });
  model.constraints.prescribe(top, 0, [](double t) { return 1e-3 * t * t; });
  model.constraints.hold(top, componentY);
  return model;
}

TEST(StaticCheckpoint, AnotherModelGoesOnWithTheSameDigits) {
  Model first = pressedBlock(), second = pressedBlock();
  const StaticReport before = solveStatics(first, 0.5, {.firstStep = 0.25});
  EXPECT_GT(before.dissipated, 0.0);
  ByteWriter archive;
  save(first, archive);
  ByteReader bytes(archive.bytes());
  load(second, bytes);
  EXPECT_EQ(second.t, 0.5);
  const StaticReport one = solveStatics(first, 1.0, {.firstStep = 0.25}),
                     other = solveStatics(second, 1.0, {.firstStep = 0.25});
  EXPECT_EQ(first.nodes.u, second.nodes.u);
  EXPECT_EQ(one.dissipated, other.dissipated);
  EXPECT_EQ(one.iterations, other.iterations);
  // Without what the terms remember it would go elsewhere.
  Model forgetful = pressedBlock();
  forgetful.nodes.u = second.nodes.u;
  forgetful.t = 0.5;
  solveStatics(forgetful, 1.0, {.firstStep = 0.25});
  EXPECT_NE(forgetful.nodes.u, first.nodes.u);
}

TEST(StaticCheckpoint, StatesOfOtherModelsAreRefusedAndChangeNothing) {
  Model block = pressedBlock(), loaded = pressedBlock();
  loaded.add(nodalForce(std::array{0}, {1.0, 0.0, 0.0}));
  ByteWriter archive;
  save(block, archive);
  const std::vector<Vec3> u = loaded.nodes.u;
  ByteReader bytes(archive.bytes());
  EXPECT_THROW(load(loaded, bytes), InputError);
  std::vector<char> longer = archive.bytes();
  longer.push_back('x');
  ByteReader more(longer);
  EXPECT_THROW(load(block, more), InputError);
  EXPECT_EQ(loaded.nodes.u, u);
}

}  // namespace
}  // namespace dovetail::fem
