// Exodus files, written by Exodus' own library, give the nodes, elements and sets that its manual says.
#include <gtest/gtest.h>
#include <unistd.h>
#include <vtk_exodusII.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/solid_io/solid_files.hpp"

namespace dovetail::solid_io {
namespace {

/// Parent coordinates of the nodes of HEX27 in the order of the manual: corners, edges below, between and above, the
/// centre, the faces z−, z+, x−, x+, y−, y+.
const std::vector<Vec3> brick{{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1},  {1, 1, 1},
                              {-1, 1, 1},   {0, -1, -1}, {1, 0, -1}, {0, 1, -1},  {-1, 0, -1}, {-1, -1, 0}, {1, -1, 0},
                              {1, 1, 0},    {-1, 1, 0},  {0, -1, 1}, {1, 0, 1},   {0, 1, 1},   {-1, 0, 1},  {0, 0, 0},
                              {0, 0, -1},   {0, 0, 1},   {-1, 0, 0}, {1, 0, 0},   {0, -1, 0},  {0, 1, 0}};
/// And of TET10: corners, edges 12, 23, 31, 14, 24, 34.
const std::vector<Vec3> tetrahedron{{0, 0, 0},     {1, 0, 0},   {0, 1, 0},   {0, 0, 1},     {0.5, 0, 0},
                                    {0.5, 0.5, 0}, {0, 0.5, 0}, {0, 0, 0.5}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
const std::vector<Vec3> square{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0},
                               {0, -1, 0},  {1, 0, 0},  {0, 1, 0}, {-1, 0, 0}};

/// A skew map, so that no two directions are alike.
Vec3 mapped(const Vec3& p) { return {2.0 * p.x + 0.3 * p.y, 1.5 * p.y - 0.2 * p.z, 1.1 * p.z + 0.1 * p.x}; }

struct Sides {
  std::vector<std::int64_t> element, side;
};
struct Content {
  std::string type;
  std::vector<Vec3> nodes;
  int dimensions = 3;
  std::vector<int> nodeSet{};
  Sides sides{};
  int mode = EX_CLOBBER;
  std::string names = "block";
};

class Written {
public:
  explicit Written(const Content& content)
      : path_(std::filesystem::temp_directory_path() / ("exodus-" + std::to_string(getpid()) + ".e")) {
    int word = sizeof(double);
    const int id = ex_create(path_.c_str(), content.mode, &word, &word);
    const auto count = static_cast<std::int64_t>(content.nodes.size());
    ex_put_init(id, "made by a test", content.dimensions, count, 1, 1, content.nodeSet.empty() ? 0 : 1,
                content.sides.element.empty() ? 0 : 1);
    std::vector<double> x, y, z;
    std::vector<int> connectivity;
    for (const Vec3& p : content.nodes) {
      x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
      connectivity.push_back(static_cast<int>(x.size()));
    }
    ex_put_coord(id, x.data(), y.data(), z.data());
    ex_put_block(id, EX_ELEM_BLOCK, 7, content.type.c_str(), 1, count, 0, 0, 0);
    ex_put_conn(id, EX_ELEM_BLOCK, 7, connectivity.data(), nullptr, nullptr);
    if (!content.names.empty()) ex_put_name(id, EX_ELEM_BLOCK, 7, content.names.c_str());
    if (!content.nodeSet.empty()) {
      ex_put_set_param(id, EX_NODE_SET, 3, static_cast<std::int64_t>(content.nodeSet.size()), 0);
      ex_put_set(id, EX_NODE_SET, 3, content.nodeSet.data(), nullptr);
    }
    if (!content.sides.element.empty()) {
      const std::vector<int> elements(content.sides.element.begin(), content.sides.element.end()),
          sides(content.sides.side.begin(), content.sides.side.end());
      ex_put_set_param(id, EX_SIDE_SET, 12, static_cast<std::int64_t>(sides.size()), 0);
      ex_put_set(id, EX_SIDE_SET, 12, elements.data(), sides.data());
      ex_put_name(id, EX_SIDE_SET, 12, "top");
    }
    ex_close(id);
  }
  ~Written() { std::filesystem::remove(path_); }
  Written(const Written&) = delete;
  Written& operator=(const Written&) = delete;
  const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

std::vector<Vec3> skew(const std::vector<Vec3>& nodes, std::size_t count) {
  std::vector<Vec3> all;
  for (std::size_t k = 0; k < count; ++k) all.push_back(mapped(nodes[k]));
  return all;
}

Vec3 meanOf(const fem::SolidMesh& mesh, std::span<const int> nodes) {
  Vec3 sum{};
  for (const int node : nodes) sum += mesh.X[static_cast<std::size_t>(node)];
  return 1.0 / static_cast<double>(nodes.size()) * sum;
}

/// Nodes on edges and faces lie in the middle of their corners.
void expectOrder(const fem::SolidMesh& mesh, const std::string& name) {
  ASSERT_EQ(mesh.groups.size(), 1u);
  const fem::ElementGroup& group = mesh.groups[0];
  const auto corners = static_cast<std::size_t>(fem::cornersOf(group.shape)), nodes = group.node.size();
  const auto edges = fem::edgesOf(group.shape);
  for (std::size_t e = 0; nodes > corners && e < edges.size(); ++e) {
    const std::array ends{group.node[static_cast<std::size_t>(edges[e][0])],
                          group.node[static_cast<std::size_t>(edges[e][1])]};
    EXPECT_LE(norm(mesh.X[static_cast<std::size_t>(group.node[corners + e])] - meanOf(mesh, ends)), 1e-14) << name;
  }
  if (nodes < 27) return;
  for (std::size_t side = 0; side < 6; ++side) {
    const fem::Face face = fem::faceOf(group, 0, side);
    EXPECT_LE(norm(mesh.X[static_cast<std::size_t>(face.node[8])] - meanOf(mesh, {face.node.data(), 4})), 1e-14);
  }
  EXPECT_LE(norm(mesh.X[static_cast<std::size_t>(group.node[26])]), 1e-14);
}

TEST(Exodus, NodesOfElementsStandWhereTheManualSays) {
  for (const auto& [type, count] : {std::pair{"HEX8", 8u}, {"HEX20", 20u}, {"hex27", 27u}, {"HEX", 8u}})
    expectOrder(readSolid(Written({type, skew(brick, count)}).path()).mesh, type);
  for (const auto& [type, count] : {std::pair{"TETRA4", 4u}, {"TETRA10", 10u}})
    expectOrder(readSolid(Written({type, skew(tetrahedron, count)}).path()).mesh, type);
  std::vector<Vec3> flat = square;
  for (Vec3& p : flat) p = {2.0 * p.x + 0.3 * p.y, 1.5 * p.y, 0.0};
  expectOrder(readSolid(Written({"QUAD8", flat, 2}).path()).mesh, "QUAD8");
}

/// Exodus' sides 1 … 6 of a brick look along y−, x+, y+, x−, z−, z+.
TEST(Exodus, SideSetsAreTheFacesOfTheManual) {
  const std::array<Vec3, 6> middle{{{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, -1}, {0, 0, 1}}};
  for (const std::size_t count : {8u, 20u, 27u})
    for (std::int64_t side = 1; side <= 6; ++side) {
      const Written file({"HEX", skew(brick, count), 3, {}, {{1}, {side}}});
      const fem::SolidMesh mesh = readSolid(file.path()).mesh;
      ASSERT_EQ(mesh.faceSets.at("top").size(), 1u);
      const fem::Face& face = mesh.faceSets.at("top")[0];
      EXPECT_LE(norm(meanOf(mesh, {face.node.data(), 4}) - mapped(middle[static_cast<std::size_t>(side - 1)])), 1e-14);
      EXPECT_TRUE(mesh.nodeSets.contains("top"));
    }
  const std::array<Vec3, 4> ofTetrahedron{{{1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {1, 1, 0}}};  // three times their middles
  for (std::int64_t side = 1; side <= 4; ++side) {
    const Written file({"TET", skew(tetrahedron, 4), 3, {}, {{1}, {side}}});
    const fem::SolidMesh mesh = readSolid(file.path()).mesh;
    const fem::Face& face = mesh.faceSets.at("top")[0];
    const Vec3 wanted = mapped(1.0 / 3.0 * ofTetrahedron[static_cast<std::size_t>(side - 1)]);
    EXPECT_LE(norm(meanOf(mesh, {face.node.data(), 3}) - wanted), 1e-14) << side;
  }
  const Written file({"QUAD4", {square.begin(), square.begin() + 4}, 2, {}, {{1}, {2}}});
  const fem::SolidMesh mesh = readSolid(file.path()).mesh;
  EXPECT_EQ(meanOf(mesh, {mesh.faceSets.at("top")[0].node.data(), 2}), (Vec3{1, 0, 0}));
}

TEST(Exodus, BlocksAndNodeSetsAreSets) {
  for (const int mode :
       {EX_CLOBBER, EX_CLOBBER | EX_NORMAL_MODEL, EX_CLOBBER | EX_64BIT_OFFSET, EX_CLOBBER | EX_64BIT_DATA}) {
    const SolidFile file = readSolid(Written({"HEX8", skew(brick, 8), 3, {5, 8}, {}, mode}).path());
    EXPECT_EQ(file.mesh.elementSets.at("block"), std::vector{0});
    EXPECT_EQ(file.mesh.nodeSets.at("node set 3"), (std::vector{4, 7}));
    EXPECT_EQ(file.nodeNumber.front(), 1);
  }
  const SolidFile unnamed = readSolid(Written({"HEX8", skew(brick, 8), 3, {}, {}, EX_CLOBBER, ""}).path());
  EXPECT_TRUE(unnamed.mesh.elementSets.contains("block 7"));
}

std::string refusal(const std::filesystem::path& path) {
  try {
    readSolid(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Exodus, FaultsAreRefused) {
  const auto expect = [](const Content& content, const char* message) {
    const std::string said = refusal(Written(content).path());
    EXPECT_NE(said.find(message), std::string::npos) << said;
  };
  expect({"WEDGE", {brick.begin(), brick.begin() + 6}},
         "elements of the type 'WEDGE' with 6 nodes are not known here [");
  expect({"HEX8", skew(brick, 8), 3, {}, {{2}, {1}}}, "there is no element 2");
  expect({"HEX8", skew(brick, 8), 3, {}, {{1}, {7}}}, "element 1 has no side 7");
  expect({"HEX8", skew(brick, 8), 3, {9}}, "node 9");
  std::vector<Vec3> nodes = skew(brick, 8);
  std::swap(nodes[0], nodes[4]), std::swap(nodes[1], nodes[5]), std::swap(nodes[2], nodes[6]);
  std::swap(nodes[3], nodes[7]);
  expect({"HEX8", nodes}, "inside out");
  nodes[0].x = std::nan("");
  expect({"HEX8", nodes}, "node 1 lies");
  EXPECT_NE(refusal("/nowhere/a.e").find("cannot be read"), std::string::npos);
  expect({"HEX8", skew(brick, 8), 3, {}, {}, EX_CLOBBER | EX_NETCDF4}, "nccopy");
}

/// Whatever a file holds, it is read or refused.
TEST(Exodus, ChangedFilesAreReadOrRefused) {
  const Written file({"HEX8", skew(brick, 8), 3, {5, 8}, {{1}, {6}}});
  std::ifstream stream(file.path(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::mt19937 random(3);
  std::size_t refused = 0;
  const std::filesystem::path path = file.path().string() + ".changed.e";
  for (int round = 0; round < 300; ++round) {
    std::string changed = bytes;
    const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
    if (round % 8 == 0) changed.resize(below(changed.size()));
    for (int k = 0; k < 1 + round % 3; ++k)
      if (!changed.empty()) changed[below(changed.size())] = static_cast<char>(below(256));
    std::ofstream(path, std::ios::binary) << changed;
    refused += !refusal(path).empty();
  }
  std::filesystem::remove(path);
  EXPECT_GT(refused, 10u);
}

}  // namespace
}  // namespace dovetail::solid_io
