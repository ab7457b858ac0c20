// Meshes of solids from files: Gmsh MSH, Abaqus INP (which CalculiX reads), Exodus; and into files of the first two.
//
// Rules of all readers. Coordinates are taken as they are; the caller converts them to metres. Nodes are put into the
// order of fem::ElementShape. Volume elements make the mesh; surface elements are taken as names for faces of volume
// elements, lines and points as names for nodes. Of a file without volume elements the quadrilaterals of four and eight
// nodes make a mesh of plane strain, 1 m thick, if they lie in a plane z = const, counter-clockwise seen from +z; its
// lines are names for faces then. Other surface elements are refused there. Nodes that no cell uses are dropped, from
// the sets too. Elements with the nodes of an earlier one are dropped, and their sets go to the earlier one. Nodes at
// equal positions stay apart (fem::joinMeshes welds). Dropped or ignored parts are listed in `notes`. Sets of one name
// that come from different things of a file are never merged: one keeps the name, the others, if they hold something
// else, are called by what they are of, "top (curves)", and a note says so. Of meshes and element sets of several
// shapes each shape has a set of its own too, "tet4" or "steel tet4", for fem::makeSolid. Byte-order marks of UTF-8 are
// passed over, texts in UTF-16 refused.
//
// Every reader throws InputError, naming the file and the line (or byte, in binary parts), for files that cannot be
// read, break off, or hold other element types, numbers that occur twice, nodes or elements that do not exist, faces
// that no volume element has, and elements that are flat or inside out: up to ten of these by their number in the file.
// Nothing that a file holds can make a reader do worse.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::solid_io {

struct SolidFile {
  fem::SolidMesh mesh;
  std::vector<std::int64_t> nodeNumber;     ///< in the file, of each node
  std::vector<std::int64_t> elementNumber;  ///< in the file, of each element
  std::vector<std::string> notes;           ///< one sentence each
};

/// Gmsh MSH 4.1 or 2.2, ASCII or binary of this machine's byte order. Physical groups become sets under their name, or
/// their number where they have none: volumes an element set, surfaces a face set and a node set, curves and points a
/// node set; in plane strain surfaces an element set, curves a face set and a node set. Files without any physical
/// group give sets "volume 1", "surface 3", "curve 2", "point 5" of the model's entities instead. Of groups of one name
/// the one of the highest dimension keeps the name. Faces are turned outwards; one between two volumes belongs to that
/// whose outward side is the surface element's own. Partitioned meshes are refused.
SolidFile readGmsh(const std::filesystem::path& path);
SolidFile gmshFromText(std::string_view bytes, const std::string& name);

/// Abaqus INP: *NODE, *ELEMENT of types C3D8, C3D20, C3D27, C3D4, C3D10 with any suffix of R, I, H, M, S, which is
/// noted and passed over (fem::Formulation chooses the integration), or of CPE4 and CPE8 with the same suffixes, and
/// shells, membranes, surface and plane elements of three to nine nodes as faces, trusses and beams as names for nodes,
/// *NSET and *ELSET (GENERATE, names of other sets), *NSET with ELSET, *SURFACE of faces (sets or elements with S1 …
/// S6) or nodes. Files of *INCLUDE, and of INPUT on *NODE and *ELEMENT, are read too, by names relative to the folder
/// of the deck, or else of the file that names them. One *PART with one *INSTANCE that is not moved may be there. The
/// part and the assembly (all that stands outside of the part) have numbers and names of their own: cards of the
/// assembly name what is the part's by INSTANCE, or as Part-1-1.4 and Part-1-1.Set-1. Where both have a set or surface
/// of one name, that name is the assembly's in the mesh, and the part's is called by its instance, "Part-1-1.Set-1". Of
/// a node set, a surface and an element set with one name the first named here keeps the name among the node sets; a
/// surface comes before an element set among the face sets. Names are compared without regard to case, outside quotes,
/// and kept as first written. A surface gives a node set too. Cards of materials, steps, constraints and so on are
/// passed over, with a note; cards that make or move nodes and elements elsewhere (*NGEN, *ELGEN, *SYSTEM …), unknown
/// parameters on the cards named here, and words that are nearly one of these cards are refused.
SolidFile readAbaqus(const std::filesystem::path& path);
/// @param name  of the deck, for errors and for the folder of what it includes
SolidFile abaqusFromText(std::string_view bytes, const std::string& name);

/// Exodus II as Cubit and MOOSE write it, in the classic formats of netCDF; files of netCDF-4 are refused. Blocks of
/// HEX8, HEX20, HEX27, TET4 and TET10 are elements, each block an element set; of SHELL, TRI and QUAD names for faces,
/// of BAR, BEAM, TRUSS and SPHERE names for nodes; without volumes QUAD4 and QUAD8 are elements of plane strain. Side
/// sets become face sets and node sets, node sets node sets, under their names, or "block 1", "side set 2", "node set
/// 3" by their ids where they have none. Results are passed over. Numbers of nodes and elements are those of their
/// order in the file, from 1; errors name the block or set in place of a line.
SolidFile exodusFromBytes(std::string_view bytes, const std::string& name);

/// .msh, .inp, or .e, .exo, .ex2, .g (Exodus), in whatever case; which of the first two it is its content says.
/// @throws InputError also on another ending
SolidFile readSolid(const std::filesystem::path& path);

/// Gmsh MSH 2.2, ASCII; coordinates read back as the same doubles; a thickness is not written. Sets become physical
/// groups; elements in several sets are written once for each, as Gmsh does.
/// @throws InputError as fem::validate, or for a name with a quote or line break, a face that no element has
void writeGmsh(const fem::SolidMesh& mesh, std::ostream& out);
/// Abaqus INP of nodes, elements and sets alone, without the thickness of plane strain, for an analysis by Abaqus or
/// CalculiX to include; numbers count from
/// 1. Names with blanks, commas, =, * or ', or that do not begin with a letter or _, are put in quotes, which CalculiX
/// does not read; nor does it have C3D27 (hex27).
/// @throws InputError as writeGmsh, and if two names of a kind differ in case alone
void writeAbaqus(const fem::SolidMesh& mesh, std::ostream& out);
/// By the ending of the name; written whole or not at all, other people's files are not replaced
/// (io/output_folder.hpp).
void writeSolid(const fem::SolidMesh& mesh, const std::filesystem::path& path);

}  // namespace dovetail::solid_io
