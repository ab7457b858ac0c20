#include <gtest/gtest.h>

#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/mesh.hpp"

namespace dovetail::fem {
namespace {

Vec3 areaVector(const Mesh& mesh, const std::array<int, 4>& face) {
  const auto at = [&](int corner) { return mesh.X[static_cast<std::size_t>(face[static_cast<std::size_t>(corner)])]; };
  return 0.5 * cross(at(2) - at(0), at(3) - at(1));
}

std::string messageOf(const Mesh& mesh) {
  try {
    validate(mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Mesh, BoxHasTheCountsAndSetsAskedFor) {
  const Mesh mesh = boxMesh({2, 3, 4}, {-1.0, 0.0, 2.0}, {1.0, 6.0, 4.0});
  EXPECT_EQ(mesh.X.size(), 3u * 4u * 5u);
  EXPECT_EQ(mesh.elements.size(), 24u);
  EXPECT_EQ(nodeSet(mesh, "x-").size(), 20u);
  EXPECT_EQ(nodeSet(mesh, "z+").size(), 12u);
  EXPECT_EQ(nodeSet(mesh, "skin").size(), 60u - 1u * 2u * 3u);
  EXPECT_EQ(faceSet(mesh, "y+").size(), 8u);
  EXPECT_EQ(faceSet(mesh, "skin").size(), 2u * (6u + 8u + 12u));
  for (const int n : nodeSet(mesh, "y+")) EXPECT_EQ(mesh.X[static_cast<std::size_t>(n)].y, 6.0);
  EXPECT_NO_THROW(validate(mesh));
}

TEST(Mesh, FacesPointOutwardAndCloseTheBox) {
  const Mesh mesh = boxMesh({2, 1, 3}, {0.0, 0.0, 0.0}, {2.0, 3.0, 4.0});
  const std::pair<const char*, Vec3> sides[] = {{"x-", {-12.0, 0.0, 0.0}}, {"x+", {12.0, 0.0, 0.0}},
                                                {"y-", {0.0, -8.0, 0.0}},  {"y+", {0.0, 8.0, 0.0}},
                                                {"z-", {0.0, 0.0, -6.0}},  {"z+", {0.0, 0.0, 6.0}}};
  for (const auto& [name, area] : sides) {
    Vec3 sum;
    for (const auto& face : faceSet(mesh, name)) sum += areaVector(mesh, face);
    EXPECT_LT(norm(sum - area), 1e-13) << name;
  }
}

TEST(Mesh, UnknownSetsListTheKnownOnes) {
  const Mesh mesh = boxMesh({1, 1, 1}, {}, {1.0, 1.0, 1.0});
  try {
    nodeSet(mesh, "top");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("\"z+\""), std::string::npos);
  }
}

TEST(Mesh, BadBoxesAreRefused) {
  EXPECT_THROW(boxMesh({0, 1, 1}, {}, {1.0, 1.0, 1.0}), InputError);
  EXPECT_THROW(boxMesh({1, 1, 1}, {}, {1.0, 0.0, 1.0}), InputError);
  EXPECT_THROW(boxMesh({1, 1, 1}, {}, {1.0, std::numeric_limits<double>::quiet_NaN(), 1.0}), InputError);
}

TEST(Mesh, BadElementsAreRefusedByNumber) {
  Mesh mesh = boxMesh({3, 1, 1}, {}, {3.0, 1.0, 1.0});
  EXPECT_EQ(messageOf(mesh), "");
  Mesh inverted = mesh;
  std::swap(inverted.elements[1][0], inverted.elements[1][6]);
  EXPECT_NE(messageOf(inverted).find("element 1"), std::string::npos);
  Mesh flat = mesh;
  for (Vec3& X : flat.X) X.z = 0.0;
  EXPECT_NE(messageOf(flat).find("element 0"), std::string::npos);
  Mesh wrongNode = mesh;
  wrongNode.elements[2][5] = 99;
  EXPECT_NE(messageOf(wrongNode).find("node 99"), std::string::npos);
  EXPECT_NE(messageOf(wrongNode).find("element 2"), std::string::npos);
  Mesh wrongSet = mesh;
  wrongSet.nodeSets["mine"] = {-1};
  EXPECT_NE(messageOf(wrongSet).find("mine"), std::string::npos);
  Mesh notFinite = mesh;
  notFinite.X[3].y = std::numeric_limits<double>::infinity();
  EXPECT_NE(messageOf(notFinite).find("node 3"), std::string::npos);
  EXPECT_NE(messageOf(Mesh{}), "");
}

}  // namespace
}  // namespace dovetail::fem
