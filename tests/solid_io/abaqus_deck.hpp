// A column of two bricks as Abaqus/CAE writes it.
#pragma once

#include "mesh_files.hpp"

namespace dovetail::solid_io {

/// Nodes 1 to 12 in three layers, bricks 1 and 2.
inline const std::string columnMesh =
    "*Node\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n5, 0., 0., 1.\n6, 1., 0., 1.\n7, 1., 1., 1.\n"
    "8, 0., 1., 1.\n9, 0., 0., 2.\n10, 1., 0., 2.\n11, 1., 1., 2.\n12, 0., 1., 2.\n"
    "*Element, type=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 5, 6, 7, 8, 9, 10, 11, 12\n";

/// @param inPart, inAssembly  cards there; `instance`  data lines of *Instance
inline std::string deckOf(const std::string& inPart, const std::string& inAssembly, const std::string& instance = "") {
  return "*Heading\n column\n*Part, name=Part-1\n" + columnMesh + inPart +
         "*End Part\n*Assembly, name=Assembly\n*Instance, name=Part-1-1, part=Part-1\n" + instance + "*End Instance\n" +
         inAssembly + "*End Assembly\n";
}

inline SolidFile column(const std::string& inPart, const std::string& inAssembly, const std::string& instance = "") {
  return abaqusFromText(deckOf(inPart, inAssembly, instance), "deck.inp");
}

/// All notes, one a line.
inline std::string notesOf(const SolidFile& file) {
  std::string all;
  for (const std::string& note : file.notes) all += note + "\n";
  return all;
}

inline std::vector<int> range(int first, int last) {
  std::vector<int> numbers;
  for (int k = first; k <= last; ++k) numbers.push_back(k);
  return numbers;
}

}  // namespace dovetail::solid_io
