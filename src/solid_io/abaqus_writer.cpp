#include <ostream>
#include <set>

#include "abaqus_types.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/plain_text.hpp"
#include "writers.hpp"

namespace dovetail::solid_io {

namespace {

/// CalculiX knows no quotes, so they are used only where it would not take the name anyway.
bool isPlain(const std::string& name) {
  const char first = name[0];
  const bool starts = (first >= 'A' && first <= 'Z') || (first >= 'a' && first <= 'z') || first == '_';
  return starts && name.find_first_of(" \t,=*'") == std::string::npos;
}

std::string written(const std::string& name) { return isPlain(name) ? name : '"' + name + '"'; }

void requireDifferent(const auto& sets, const char* kind) {
  std::set<std::string> seen;
  for (const auto& entry : sets)
    if (!seen.insert(io::lower(entry.first)).second)
      throw InputError("another name differs in case alone", std::string(kind) + " set \"" + entry.first + "\"",
                       "give names that differ otherwise");
}

/// Numbers from 1, with `perLine` of them on a line; all but the last line end in a comma if the list goes on.
void writeNumbers(std::ostream& out, std::span<const int> numbers, std::size_t perLine, bool goesOn) {
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const bool last = k + 1 == numbers.size(), lineEnds = (k + 1) % perLine == 0;
    out << numbers[k] + 1 << (last ? "\n" : lineEnds ? (goesOn ? ",\n" : "\n") : ", ");
  }
}

void writeElements(const fem::SolidMesh& mesh, std::ostream& out) {
  int number = 0;
  for (const fem::ElementGroup& group : mesh.groups) {
    const auto n = static_cast<std::size_t>(fem::nodesOf(group.shape));
    out << "*ELEMENT, TYPE=" << abaqusName(group.shape) << '\n';
    for (std::size_t e = 0; e < group.size(); ++e) {
      std::vector<int> numbers(n + 1);
      numbers[0] = number++;
      for (std::size_t k = 0; k < n; ++k)
        numbers[1 + static_cast<std::size_t>(abaqusPlace(group.shape, static_cast<int>(k)))] = group.node[n * e + k];
      writeNumbers(out, numbers, 11, true);
    }
  }
}

fem::ElementShape shapeOf(const fem::SolidMesh& mesh, int element) {
  auto e = static_cast<std::size_t>(element);
  for (const fem::ElementGroup& group : mesh.groups) {
    if (e < group.size()) return group.shape;
    e -= group.size();
  }
  return {};
}

void writeSurfaces(const fem::SolidMesh& mesh, std::ostream& out) {
  const FaceFinder finder(mesh);
  for (const auto& [name, faces] : mesh.faceSets) {
    out << "*SURFACE, NAME=" << written(name) << ", TYPE=ELEMENT\n";
    for (const fem::Face& face : faces) {
      const Side side = requireSide(finder, face, name);
      const fem::ElementShape shape = shapeOf(mesh, side.element);
      int number = 1;
      while (sideOfFace(shape, number) != side.side) ++number;
      out << side.element + 1 << ", S" << number << '\n';
    }
  }
}

}  // namespace

void writeAbaqus(const fem::SolidMesh& mesh, std::ostream& out) {
  requireWritable(mesh);
  requireDifferent(mesh.nodeSets, "node");
  requireDifferent(mesh.elementSets, "element");
  requireDifferent(mesh.faceSets, "face");
  out << "** " << mark() << "\n*NODE\n";
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    out << n + 1 << ", " << formatNumber(mesh.X[n].x) << ", " << formatNumber(mesh.X[n].y) << ", "
        << formatNumber(mesh.X[n].z) << '\n';
  writeElements(mesh, out);
  for (const auto& [name, nodes] : mesh.nodeSets) {
    out << "*NSET, NSET=" << written(name) << '\n';
    writeNumbers(out, nodes, 10, false);
  }
  for (const auto& [name, elements] : mesh.elementSets) {
    out << "*ELSET, ELSET=" << written(name) << '\n';
    writeNumbers(out, elements, 10, false);
  }
  writeSurfaces(mesh, out);
}

}  // namespace dovetail::solid_io
