// Solids of all shapes in VTU files (VTK's XML format of unstructured grids), for ParaView and back.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/solid_io/solid_files.hpp"

namespace dovetail::solid_io {

/// Values of a field, side by side: `components` per point or cell. Three are a vector, nine a tensor (row-major).
struct VtuField {
  std::string name;
  std::span<const double> values;
  int components = 1;
};
struct VtuFields {
  std::vector<VtuField> perPoint{}, perCell{};
  std::span<const Vec3> displacement{};  ///< m; written as point field "displacement"; empty = none
  std::optional<double> time{};          ///< s; written as field data "TimeValue"
};

/// The file's bytes: appended raw binary, compressed, doubles. Points are the reference positions; warp by
/// "displacement" to see the deformed solid. Cells come in the order of the elements, as VTK's types 12, 25, 29, 10,
/// 24, 9 and 23; the thickness of plane strain is not written. Node sets and element sets become arrays of zeros and
/// ones under their names, or as "name (set)" beside a field of that name; face sets are not written.
/// @throws InputError as fem::validate; for a field of another size than the mesh, an empty name, or one of a field
///         that occurs twice
std::string vtuText(const fem::SolidMesh& mesh, const VtuFields& fields = {}, const io::KeyValues& provenance = {});
/// The same into a file; other people's files are not replaced (io/output_folder.hpp).
void writeVtu(const std::filesystem::path& path, const fem::SolidMesh& mesh, const VtuFields& fields = {},
              const io::KeyValues& provenance = {});

/// A solid from a VTU file, by the rules of solid_files.hpp: cells of types 12, 25, 29, 10 and 24 are elements; of
/// types 5, 22, 9, 23 and 28 names for faces, of 1, 3 and 21 names for nodes. Without volumes 9 and 23 are elements of
/// plane strain, 3 and 21 names for their faces. Arrays of whole numbers with one
/// component become sets: of zeros and ones, a set of the array's name where it is one; of other numbers, a set "name
/// number" for each (arrays with more than 100 different numbers, such as identifiers, are passed over). Cells that
/// VTK's vtkGhostType calls copies, refined or hidden are left out. Numbers of nodes and elements are those of points
/// and cells from 0.
/// @throws InputError as the readers of solid_files.hpp, naming the cell instead of a line
SolidFile readVtu(const std::filesystem::path& path);

}  // namespace dovetail::solid_io
