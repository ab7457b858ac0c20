// Bonds and drives of a scene.
#include "dovetail/dem/model/loads.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

std::string row(const std::string& name, double x, int count) {
  std::string text = R"({"from": "list", "name": ")" + name + R"(", "density": 2500, "spheres": [)";
  for (int k = 0; k < count; ++k)
    text +=
        (k > 0 ? "," : "") + std::string(R"({"at": [)") + std::to_string(x + 0.02 * k) + R"(, 0, 0], "radius": 0.01})";
  return text + "]}";
}
const std::string material = R"("gap": 1e-6, "youngs_modulus": 1e7, "poisson_ratio": 0.2)";

TEST(SceneBonds, JoinTheGroupsThatAreNamed) {
  const std::string particles = R"("particles": [)" + row("a", 0, 3) + "," + row("b", 0.06, 4) + "],";
  const auto count = [&](const std::string& bonds) {
    const Built built = started(sceneOf(particles + "\"bonds\": [" + bonds + "],"));
    return dem::bonds(built.run->grains).size();
  };
  EXPECT_EQ(count(R"({"group": "a", )" + material + "}"), 2U);
  EXPECT_EQ(count(R"({"group": "a", "with": "b", )" + material + "}"), 1U);
  EXPECT_EQ(count(R"({"group": "a", )" + material + R"(}, {"group": "b", )" + material + "}"), 5U);
}

TEST(SceneBonds, PullAndBreakAtTheirStrength) {
  Built built = started(sceneOf(R"("particles": [)" + row("fixed", 0, 1) + "," + row("pulled", 0.02, 1) + R"(],
      "bonds": [{"group": "fixed", "with": "pulled", "tensile_strength": "10 kPa", )" +
                                material + R"(}],
      "drives": [{"group": "fixed"}, {"group": "pulled", "velocity": [0.01, 0, 0]}],)"));
  dem::Model& grains = built.run->grains;
  // E A/L · stretch over A = strength: stretch = L · 10 kPa/10 MPa = 20 µm, after 2 ms.
  built.run->advance(190);
  ASSERT_EQ(dem::bonds(grains).size(), 1U);
  const double area = std::acos(-1.0) * 1e-4;
  EXPECT_NEAR(grains.particles.f[0].x, 1e7 * area * 0.01 * 0.0019 / 0.02, 1e-3);
  built.run->advance(20);
  EXPECT_EQ(dem::bonds(grains).size(), 0U);
  EXPECT_GT(built.run->ledger().joules("particles: fracture"), 0.0);
}

TEST(SceneBonds, WhatCannotBeIsRefused) {
  const std::string particles = R"("particles": [)" + row("left", 0, 3) + "],";
  expectParts(refusalOfRun(particles + R"("bonds": [{"group": "leftt", )" + material + "}],"),
              {"write \"left\"", "bonds.0"});
  expectParts(
      refusalOfRun(particles + R"("bonds": [{"group": "left", "gap": 0, "youngs_modulus": 0, "poisson_ratio": 0}],)"),
      {"youngs_modulus", "bonds.0"});
  expectParts(
      refusalOfRun(R"("particles": [)" + row("left", 0, 1) + R"(], "bonds": [{"group": "left", )" + material + "}],"),
      {"no two unbonded grains", "bonds.0"});
  expectParts(refusalOfRun(R"("particles": [)" + row("a", 0, 1) + "," + row("a", 1, 1) + "],"),
              {"two groups \"a\"", "particles.1"});
  expectParts(refusalOfRun(particles + R"("drives": [{"group": "right"}],)"), {"\"right\"", "drives.0"});
}

}  // namespace
}  // namespace dovetail::scene::test
