// Laws by pair of contact materials.
#include "dovetail/dem/model/walls.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string linear =
    R"({"between": "glass", "and": "steel", "law": "linear", "stiffness": 1e4, "restitution": 0.5})";
const std::string hertz =
    R"({"between": "glass", "and": "steel", "law": "Hertz", "youngs_modulus": 1e7, "poisson_ratio": 0.2,
        "second": {"youngs_modulus": 4e7, "poisson_ratio": 0.3}})";

std::string grain(const std::string& material, double x, double z = 1.0) {
  return R"({"from": "list", "density": 2500, )" +
         (material.empty() ? "" : R"("contact_material": ")" + material + R"(", )") + R"("spheres": [{"at": [)" +
         std::to_string(x) + ", 0, " + std::to_string(z) + R"(], "radius": 0.1, "velocity": [0, 0, -1]}]})";
}
std::string walls(const std::string& floor) {
  return R"("walls": [{"shape": "plane", "point": [0, 0, 0.895], "normal": [0, 0, 1])" +
         (floor.empty() ? "" : R"(, "contact_material": ")" + floor + "\"") + "}],";
}

TEST(SceneContacts, PairsHaveTheirLaws) {
  Built built = startedWith(
      R"("contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.9}, "contacts": [)" + linear + "],",
      R"("particles": [)" + grain("", 0) + "," + grain("glass", 1) + "," + grain("steel", 2) + "]," + walls("steel"));
  built.run->advance(20000);
  const auto& v = built.run->grains.particles.v;
  EXPECT_NEAR(v[0].z, 0.9, 1e-3);
  EXPECT_NEAR(v[1].z, 0.5, 1e-3);
  EXPECT_NEAR(v[2].z, 0.9, 1e-3);  // steel on steel: that of all other pairs
}

TEST(SceneContacts, HertzKnowsBothSurfaces) {
  Built built = startedWith(R"("contacts": [)" + hertz + "," + replaced(hertz, "steel", "glass") + "],",
                            R"("particles": [)" + grain("glass", 0, 0.99) + "]," + walls("steel"));
  const double modulus = 1.0 / ((1.0 - 0.04) / 1e7 + (1.0 - 0.09) / 4e7), overlap = 0.895 + 0.1 - 0.99;
  EXPECT_NEAR(built.run->grains.particles.f[0].z, 4.0 / 3.0 * modulus * std::sqrt(0.1) * std::pow(overlap, 1.5), 1e-6);
}

TEST(SceneContacts, ATableOfOneLawHasTheDigitsOfTheLaw) {
  const std::string keys = R"("law": "linear", "stiffness": 1e4, "restitution": 0.8, "friction": 0.3)";
  const auto run = [&](const std::string& laws, const std::string& material) {
    Built built = startedWith(laws, R"("particles": [)" + grain(material, 0, 0.99) + "," + grain(material, 0.15, 1.1) +
                                        "]," + walls(material));
    built.run->advance(500);
    return built.run->grains.particles.x;
  };
  EXPECT_EQ(run(R"("contact": {)" + keys + "},", ""),
            run(R"("contacts": [{"between": "a", "and": "a", )" + keys + "}],", "a"));
}

TEST(SceneContacts, NewcomersClumpsAndSurfacesHaveMaterials) {
  const Built built = startedWith(
      R"("contact": {"law": "linear", "stiffness": 1e4}, "contacts": [)" + linear + "],",
      R"("clumps": [{"spheres": [{"at": [0, 0, 0], "radius": 0.1}], "density": 1000, "at": [9, 0, 0], "contact_material": "steel"}],
         "insertions": [{"region": [[0, 0, 5], [1, 1, 6]], "radius": {"smallest": 0.1, "largest": 0.1}, "density": 1000,
           "number_per_second": 1e6, "contact_material": "glass"}],)");
  built.run->advance(3);
  const dem::Particles& p = built.run->grains.particles;
  ASSERT_GT(p.size(), 2U);
  EXPECT_EQ(p.material[0], 2);
  EXPECT_EQ(p.material.back(), 1);
}

TEST(SceneContacts, WhatCannotBeIsRefused) {
  const std::string one = R"("particles": [)" + grain("glass", 0) + "]," + walls("steel");
  const std::string common = R"("contact": {"law": "linear", "stiffness": 1e4}, )";
  expectParts(refusalWith(common, one), {"\"contacts\" has no law for", "\"glass\"", "particles.0"});
  expectParts(refusalWith(common + R"("contacts": [)" + linear + "],", R"("particles": [)" + grain("glas", 0) + "],"),
              {"write \"glass\"", "particles.0"});
  expectParts(refusalWith(R"("contacts": [)" + linear + "," + linear + "],", one), {"twice", "contacts.1"});
  expectParts(refusalWith(common + R"("contacts": [)" + hertz + "],", one),
              {"write \"law\": \"linear\"", "contacts.0"});
  expectParts(refusalWith(R"("contacts": [)" + linear + "],",
                          R"("particles": [)" + grain("glass", 0) + "," + grain("glass", 1) + "],"),
              {"no law between \"glass\" and \"glass\"", "s.json:"});
  expectParts(
      refusalWith(R"("contacts": [)" + linear + "],", R"("particles": [)" + grain("", 0) + "]," + walls("steel")),
      {"contact_material"});
  expectParts(refusalWith(R"("contacts": [)" +
                              replaced(linear, "}", R"(, "second": {"youngs_modulus": 1, "poisson_ratio": 0}})") + "],",
                          one),
              {"no second modulus", "contacts.0"});
  expectParts(refusalWith(R"("contacts": [)" + replaced(linear, "0.5", "1.5") + "],", one),
              {"restitution", "contacts.0"});
}

}  // namespace
}  // namespace dovetail::scene::test
