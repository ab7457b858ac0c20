// Meshes with sets of every kind, and MSH texts of all four variants.
#pragma once

#include <cstring>
#include <sstream>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/solid_io/solid_files.hpp"

namespace dovetail::solid_io {

/// A box with curved faces, node, face and element sets; coordinates with all their digits.
inline fem::SolidMesh testMesh(fem::ElementShape shape) {
  fem::SolidMesh mesh = fem::boxOf(shape, {2, 3, 1}, {0.1, -0.2, 0.3}, {1.0, 0.9, 1.0});
  if (fem::dimensionOf(shape) == 2) {
    mesh.thickness = 1.0;  // files do not say it
    for (Vec3& X : mesh.X) X = {X.x + 0.1 * X.y * X.y, X.y + 0.2 * X.x * X.z, X.z / 3.0};
  } else {
    for (Vec3& X : mesh.X) X = {X.x + 0.1 * X.y * X.y, X.y + 0.2 * X.x * X.z, X.z / 3.0 * (1.0 + 0.2 * X.x)};
  }
  mesh.elementSets["matrix"] = {0, 1, 2};
  mesh.elementSets["all but one"] = {1, 2, 3, 4, 5};
  return mesh;
}

/// Faces by their corners, whatever the order of the faces.
inline std::vector<std::vector<int>> sortedFaces(const std::vector<fem::Face>& faces) {
  std::vector<std::vector<int>> result;
  for (const fem::Face& face : faces) result.emplace_back(face.node.begin(), face.node.end());
  std::sort(result.begin(), result.end());
  return result;
}

template <class Call>
std::string messageOf(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Writes numbers as text or as bytes.
class NumberWriter {
public:
  explicit NumberWriter(bool binary) : binary_(binary) {}
  void line(const std::string& text) { out_ += text + "\n"; }
  void ints(const std::vector<int>& values) {
    for (const int value : values) put(value);
  }
  void sizes(const std::vector<std::uint64_t>& values) {
    for (const std::uint64_t value : values) put(value);
  }
  void reals(const std::vector<double>& values) {
    for (const double value : values) put(value);
  }
  void point(const Vec3& X) { reals({X.x, X.y, X.z}); }
  const std::string& result() const { return out_; }

private:
  template <class Value>
  void put(Value value) {
    if (binary_) {
      char bytes[sizeof(Value)];
      std::memcpy(bytes, &value, sizeof(Value));
      out_.append(bytes, sizeof(Value));
    } else if constexpr (std::is_same_v<Value, double>) {
      out_ += formatNumber(value) + "\n";
    } else {
      out_ += std::to_string(value) + " ";
    }
  }
  bool binary_;
  std::string out_;
};

/// A tetrahedron of ten nodes as Gmsh has it, with the nodes numbered 5, 10, … 50.
struct GmshTet {
  std::vector<Vec3> X = {{0, 0, 0},     {1, 0, 0},   {0, 1, 0},   {0, 0, 1},     {0.5, 0, 0},
                         {0.5, 0.5, 0}, {0, 0.5, 0}, {0, 0, 0.5}, {0, 0.5, 0.5}, {0.5, 0, 0.5}};
  std::vector<int> nodes = {5, 10, 15, 20, 25, 30, 35, 40, 45, 50};
  std::vector<int> face = {5, 10, 15, 25, 30, 35};  ///< seen from inside
};

inline void writeNodes4(NumberWriter& out, const GmshTet& tet) {
  out.line("$Nodes");
  out.sizes({2, 10, 5, 50});
  out.ints({2, 2, 1});  // one node with two parameters of a surface, the others without
  out.sizes({1, 5});
  out.point(tet.X[0]);
  out.reals({0.25, 0.75});
  out.ints({3, 3, 0});
  out.sizes({9});
  for (std::size_t k = 1; k < 10; ++k) out.sizes({5 * (k + 1)});
  for (std::size_t k = 1; k < 10; ++k) out.point(tet.X[k]);
  out.line("\n$EndNodes");
}

inline void writeElements4(NumberWriter& out, const GmshTet& tet) {
  out.line("$Elements");
  out.sizes({3, 3, 1, 3});
  out.ints({0, 4, 15});
  out.sizes({1, 1, 20});
  out.ints({2, 2, 9});
  out.sizes({1, 2});
  out.sizes({tet.face.begin(), tet.face.end()});
  out.ints({3, 3, 11});
  out.sizes({1, 3});
  out.sizes({tet.nodes.begin(), tet.nodes.end()});
  out.line("\n$EndElements");
}

inline void writeEntities4(NumberWriter& out, bool grouped) {
  const std::vector<std::uint64_t> groups = {grouped ? 1u : 0u};
  out.line("$Entities");
  out.sizes({1, 0, 1, 1});
  const auto entity = [&](int tag, int dimension, int group) {
    out.ints({tag});
    out.reals(std::vector<double>(dimension == 0 ? 3 : 6, 0.0));
    out.sizes(groups);
    if (grouped) out.ints({group});
  };
  entity(4, 0, 9);
  entity(2, 2, 7);
  out.sizes({0});
  entity(3, 3, 1);
  out.sizes({1});
  out.ints({-2});
  out.line("\n$EndEntities");
}

inline void writeElements2(NumberWriter& out, const GmshTet& tet, bool binary, bool grouped) {
  out.line("$Elements\n3");
  const auto element = [&](int number, int type, int group, int entity, const std::vector<int>& nodes) {
    out.ints(binary ? std::vector<int>{type, 1, 2, number} : std::vector<int>{number, type, 2});
    out.ints({grouped ? group : 0, entity});
    out.ints(nodes);
  };
  element(1, 15, 9, 4, {20});
  element(2, 9, 7, 2, tet.face);
  element(3, 11, 1, 3, tet.nodes);
  out.line("\n$EndElements");
}

/// Groups: the volume "body", the face in the unnamed 7, the upper corner "the tip".
inline std::string gmshTet(bool version4, bool binary, bool grouped = true) {
  const GmshTet tet;
  NumberWriter out(binary);
  out.line("$MeshFormat");
  out.line(std::string(version4 ? "4.1 " : "2.2 ") + (binary ? "1 8" : "0 8"));
  if (binary) out.ints({1});
  out.line("\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"body\"\n0 9 \"the tip\"\n$EndPhysicalNames");
  if (version4) {
    writeEntities4(out, grouped);
    writeNodes4(out, tet);
    writeElements4(out, tet);
    return out.result();
  }
  out.line("$Nodes\n10");
  for (std::size_t k = 0; k < 10; ++k) {
    out.ints({tet.nodes[k]});
    out.point(tet.X[k]);
  }
  out.line("\n$EndNodes");
  writeElements2(out, tet, binary, grouped);
  return out.result();
}

}  // namespace dovetail::solid_io
