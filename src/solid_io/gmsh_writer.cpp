#include <ostream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/io/provenance.hpp"
#include "gmsh_types.hpp"
#include "writers.hpp"

namespace dovetail::solid_io {

namespace {

/// One record of $Elements.
struct Record {
  int code, group;
  std::vector<int> nodes;
};

std::vector<Record> recordsOf(const fem::SolidMesh& mesh) {
  std::vector<Record> records;
  int group = 0;
  for (const auto& [name, nodes] : mesh.nodeSets) {
    ++group;
    for (const int node : nodes) records.push_back({15, group, {node}});
  }
  const FaceFinder finder(mesh);
  for (const auto& [name, faces] : mesh.faceSets) {
    ++group;
    for (const fem::Face& face : faces) {
      requireSide(finder, face, name);
      records.push_back(
          {gmshCode(face.shape), group, {face.node.begin(), face.node.begin() + fem::nodesOf(face.shape)}});
    }
  }
  std::vector<std::vector<int>> groupsOf(mesh.elementCount());
  for (const auto& [name, elements] : mesh.elementSets) {
    ++group;
    for (const int e : elements) groupsOf[static_cast<std::size_t>(e)].push_back(group);
  }
  std::size_t number = 0;
  for (const fem::ElementGroup& cells : mesh.groups)
    for (std::size_t e = 0; e < cells.size(); ++e, ++number) {
      const auto order = gmshOrder(cells.shape);
      Record record{gmshCode(cells.shape), 0, std::vector<int>(order.size())};
      for (std::size_t k = 0; k < order.size(); ++k)
        record.nodes[static_cast<std::size_t>(order[k])] = cells.node[e * order.size() + k];
      if (groupsOf[number].empty()) groupsOf[number].push_back(0);
      for (const int g : groupsOf[number]) {
        record.group = g;
        records.push_back(record);
      }
    }
  return records;
}

void writeNames(const fem::SolidMesh& mesh, std::ostream& out) {
  out << "$PhysicalNames\n" << mesh.nodeSets.size() + mesh.faceSets.size() + mesh.elementSets.size() << '\n';
  int group = 0;
  for (const auto& entry : mesh.nodeSets) out << "0 " << ++group << " \"" << entry.first << "\"\n";
  const int dimension = fem::dimensionOf(mesh);
  for (const auto& entry : mesh.faceSets) out << dimension - 1 << ' ' << ++group << " \"" << entry.first << "\"\n";
  for (const auto& entry : mesh.elementSets) out << dimension << ' ' << ++group << " \"" << entry.first << "\"\n";
  out << "$EndPhysicalNames\n";
}

}  // namespace

std::string mark() { return io::withMark({})[0].second; }

void requireWritable(const fem::SolidMesh& mesh) {
  fem::validate(mesh);
  const auto check = [](const auto& sets, const char* kind) {
    for (const auto& entry : sets)
      if (entry.first.empty() || entry.first.find_first_of("\"\n\r") != std::string::npos)
        throw InputError("its name is empty or holds a quote or line break",
                         std::string(kind) + " set \"" + entry.first + "\"", "give it a plain name");
  };
  check(mesh.nodeSets, "node");
  check(mesh.faceSets, "face");
  check(mesh.elementSets, "element");
}

Side requireSide(const FaceFinder& finder, const fem::Face& face, const std::string& set) {
  const Side side = finder.find(std::span(face.node).first(static_cast<std::size_t>(fem::cornersOf(face.shape))));
  if (side.element < 0)
    throw InputError("a face of it belongs to no element", "face set \"" + set + "\"", "give faces of elements");
  return side;
}

void writeGmsh(const fem::SolidMesh& mesh, std::ostream& out) {
  requireWritable(mesh);
  const std::vector<Record> records = recordsOf(mesh);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\n" << mark() << "\n$EndComments\n";
  writeNames(mesh, out);
  out << "$Nodes\n" << mesh.X.size() << '\n';
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    out << n + 1 << ' ' << formatNumber(mesh.X[n].x) << ' ' << formatNumber(mesh.X[n].y) << ' '
        << formatNumber(mesh.X[n].z) << '\n';
  out << "$EndNodes\n$Elements\n" << records.size() << '\n';
  for (std::size_t r = 0; r < records.size(); ++r) {
    out << r + 1 << ' ' << records[r].code << " 2 " << records[r].group << ' '
        << (records[r].group > 0 ? records[r].group : 1);
    for (const int node : records[r].nodes) out << ' ' << node + 1;
    out << '\n';
  }
  out << "$EndElements\n";
}

}  // namespace dovetail::solid_io
