// Keys for schemes of the literature.
#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "warning_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string grain =
    R"("particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0.3, 0.3, 1.099], "radius": 0.1}]}],)";
std::string plate(const std::string& solid, const std::string& coupling) {
  return grain + R"("solids": [{"name": "plate", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 0], [1, 1, 1]],
    "material": {"law": "deformed-metric", "youngs_modulus": 1e6, "poisson_ratio": 0.2, "density": 1000},
    "supports": [{"on": "z-"}])" +
         solid + R"(}], "couplings": [{"type": "surface", "solid": "plate")" + coupling + "}],";
}

const surface::SurfaceCoupler& couplingOf(const Built& built) {
  return std::as_const(built.run->grains).terms.all<surface::SurfaceContact>().front()->coupling();
}

TEST(PublishedSchemes, SurfaceCouplingsTakeTransferEdgesAndSurface) {
  const Built spread =
      started(sceneOf(plate("", R"(, "kernel": 0.4, "kernel_shape": "gauss", "kernel_correction": "none",
                           "transfer": "spread", "edges": "deepest")")));
  spread.run->advance(5);
  const surface::SurfaceCoupler& spreads = couplingOf(spread);
  EXPECT_EQ(spreads.options().edges, dem::EdgeRule::paper);
  EXPECT_FALSE(surface::hasKernel(spreads.skin()));  // the gap is local
  EXPECT_GT(spreads.load().touched.size(), 4u);      // the load is not
  EXPECT_NE(spreads.madeByTransfer(), 0.0);
  const Built smooth = startedWith(R"("contact": {"law": "linear", "stiffness": 1e4},)",
                                   plate("", R"(, "kernel": "none", "surface": "smooth")"));
  EXPECT_FALSE(couplingOf(smooth).onFacets());
  const Built plain = started(sceneOf(plate("", R"(, "kernel": "none")")));
  plain.run->advance(5);
  EXPECT_EQ(couplingOf(plain).madeByTransfer(), 0.0);
}

TEST(PublishedSchemes, DashpotsMayPull) {
  const auto pulls = [](const std::string& more) {
    const std::string law = R"("contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.3)" + more + "},";
    const Built built = startedWith(law, R"("particles": [{"from": "list", "density": 2500, "spheres": [
      {"at": [0, 0, 0], "radius": 0.1}, {"at": [0, 0, 0.1999], "radius": 0.1, "velocity": [0, 0, 5]}]}],)");
    return built.run->grains.particles.f[1].z < 0.0;
  };
  EXPECT_TRUE(pulls(R"(, "tension": true)"));
  EXPECT_FALSE(pulls(""));
}

TEST(PublishedSchemes, ALagIsBooked) {
  Scene scene = sceneOf(plate("", ""));
  EXPECT_EQ(scene.steps.lag, 0);
  scene.steps.lag = 1;
  Built built = started(scene);
  built.run->advance(20);
  EXPECT_NE(built.run->ledger().joules("staggering error (minus what it made)"), 0.0);
}

TEST(PublishedSchemes, SurfacePartsThatExcludeEachOtherAreRefused) {
  expectParts(refusalOfRun(plate("", R"(, "transfer": "spread", "surface": "smooth", "kernel_correction": "none")")),
              {"couplings.0", "smooth", "\"surface\": \"flat\""});
  expectParts(refusalOfRun(plate("", R"(, "edges": "deepest", "surface": "smooth")")),
              {"couplings.0", "no edges", "\"edges\": \"projected\""});
  expectParts(refusalOfRun(plate("", R"(, "transfer": "spread")")),
              {"couplings.0", "\"symmetric\" is the default", "\"kernel_correction\": \"none\""});
}

/// Their kernels end where their own faces do.
TEST(PublishedSchemes, SpreadLoadsWantASetOfTheirOwn) {
  const std::string spread = R"(, "transfer": "spread", "kernel": 0.4, "kernel_correction": "none", "on": "z+")";
  const std::string two = R"(}, {"type": "surface", "solid": "plate", "on": "x+", "kernel": "none")";
  EXPECT_EQ(refusalOfRun(plate("", spread)), "");
  expectParts(refusalOfRun(plate("", spread + two)), {"couplings.0", "faces of another coupling", "name one set"});
  expectParts(refusalOfRun(plate("", spread) + R"("periodic": {"box": [[0, 0, 0], [1, 1, 1]], "axes": ["x"]},)"),
              {"couplings.0", "a periodic boundary", "\"kernel\": \"none\""});
}

std::string soil(const std::string& solid, const std::string& overlap) {
  return R"("particles": [{"from": "lattice", "lattice": "simple-cubic", "radius": 0.1, "density": 2500,
                           "box": [[0, 0, 0], [0.4, 0.4, 2]]}],
    "solids": [{"name": "soil", "mesh": "box", "cells": [1, 1, 4], "box": [[0, 0, -0.8], [0.4, 0.4, 0.8]],
      "material": {"law": "axial-springs", "youngs_modulus": 5e4, "density": 1309}, "supports": [{"on": "z-"}])" +
         solid + R"(}], "couplings": [{"type": "overlap", "solid": "soil", "solid_border": 0.8, "particle_border": 0)" +
         overlap + "}],";
}

TEST(PublishedSchemes, OverlapsTakeGapRowsAndDashpot) {
  const auto rowsWith = [](const std::string& overlap) {
    const Built built = started(sceneOf(soil(R"(, "stepping": "implicit")", overlap)));
    return std::as_const(built.run->grains).terms.all<arlequin::ArlequinCoupling>().front()->operators().rows();
  };
  const std::size_t perNode = rowsWith(R"(, "floor": 0.1)");
  const std::size_t perElement = rowsWith(R"(, "floor": 0.1, "constraint": "dashpot", "penalty": 1e6, "gap": "nodal",
    "rows": "per-element", "order": "staggered", "kernel": 0.3, "kernel_normalised": false, "kernel_reach": "outside")");
  EXPECT_GT(perElement, perNode);  // inner nodes have one for each of two elements
}

TEST(PublishedSchemes, OverlapPartsThatExcludeEachOtherAreRefused) {
  const auto refusal = [](const char* solid, const char* overlap) { return refusalOfRun(soil(solid, overlap)); };
  expectParts(refusal("", R"(, "constraint": "dashpot")"), {"couplings.0", "give penalty a number"});
  expectParts(refusal("", R"(, "order": "staggered")"), {"couplings.0", "\"constraint\": \"dashpot\""});
  expectParts(refusal("", R"(, "order": "staggered", "constraint": "dashpot", "penalty": 1e6)"),
              {"couplings.0", "\"stepping\": \"implicit\""});
  expectParts(refusal("", R"(, "kernel_reach": "outside")"), {"couplings.0", "\"gap\": \"nodal\""});
  expectParts(refusal(R"(, "stepping": "implicit")", R"(, "absorber": 10)"),
              {"couplings.0", "\"stepping\": \"explicit\""});
  expectParts(refusal("", R"(, "gap": "nodal", "kernel_reach": "outside", "kernel": 0.3, "absorber": 10)"),
              {"couplings.0", "leave kernel_reach or absorber out"});
  Scene lags = sceneOf(soil("", ""));
  lags.steps.lag = 1;
  EXPECT_THROW(build(lags), InputError);
}

TEST(PublishedSchemes, KeysThatAnotherOneMakesIdleAreTold) {
  expectParts(warningsOf(soil("", R"(, "dashpot_matrix": "consistent")")), {"couplings.0.dashpot_matrix does nothing"});
  expectParts(warningsOf(soil("", R"(, "constraint": "multiplier", "penalty": 1e6)")),
              {"couplings.0.penalty does nothing"});
  expectParts(warningsOf(soil("", R"(, "kernel_normalised": false)")), {"there is no kernel"});
  expectParts(warningsOf(plate("", R"(, "kernel": "none", "kernel_shape": "gauss")")),
              {"couplings.0.kernel_shape does nothing"});
}

}  // namespace
}  // namespace dovetail::scene::test
