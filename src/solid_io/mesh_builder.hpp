// Gathers what a file says, by the file's own numbers, and makes a mesh of it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "dovetail/io/text_source.hpp"
#include "dovetail/solid_io/solid_files.hpp"

namespace dovetail::solid_io {

using io::lower, io::shown, io::TextSource, io::trimmed;

using Label = std::int64_t;

/// "1 node lies", "2 nodes lie".
inline std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// What a surface element is where there are volumes, a face by its corners, and where there are none: a cell of plane
/// strain, or something that we do not take.
struct SurfaceKind {
  int corners;
  std::optional<fem::ElementShape> plane;
  const char* otherwise;  ///< "a triangle", where it is no cell
};
/// By the number of nodes, 3, 4, 6, 8 or 9.
SurfaceKind surfaceOf(int nodes);

/// A set as the file has it. Sets of one name that come from different things of the file (cards, dimensions, arrays)
/// are never merged: that of the lowest rank keeps the name.
struct SetKey {
  std::string name;
  int rank = 0;
  std::string origin;  ///< of what, for the name of the others: "top (curves)"
  auto operator<=>(const SetKey&) const = default;
};

/// `place` is always an offset in the source, for errors that only show at the end.
class MeshBuilder {
public:
  explicit MeshBuilder(const TextSource& source) : source_(source) {}

  /// @param X  m; beyond ±1e15 it is refused
  void addNode(Label label, const Vec3& X, std::size_t place);
  /// @param nodes  in our order
  void addCell(Label label, fem::ElementShape shape, std::span<const Label> nodes, std::size_t place);
  /// A surface element, its nodes in our order. If `mustFit`, it has to be a face of a volume element where there are
  /// some.
  void addFace(Label label, const SurfaceKind& kind, std::span<const Label> nodes, std::size_t place,
               bool mustFit = true);

  /// What an element of one dimension or none is for.
  enum class LineUse {
    names,   ///< names its nodes
    line,    ///< the same; a face of plane cells, if it fits
    mustFit  ///< the same; a face of plane cells
  };
  void addLine(Label label, std::span<const Label> nodes, std::size_t place, LineUse use = LineUse::names);

  /// Nodes and elements of sets must be there already.
  void addNodeToSet(const SetKey& set, Label node, std::size_t place);
  /// Cells go to element sets, faces to face sets, nodes of other elements to node sets.
  void addElementToSet(const SetKey& set, Label element, std::size_t place);
  /// Face `side` of fem::localFacesOf.
  void addSideToSet(const SetKey& set, Label element, int side, std::size_t place);
  void note(const std::string& sentence) { notes_.push_back(sentence); }

  std::size_t nodeCount() const { return X_.size(); }
  /// Cells, surface elements and lines.
  std::size_t elementCount() const { return cell_.size() + face_.size() + lines_.size(); }
  bool hasElement(Label label) const {
    return cells_.contains(label) || faces_.contains(label) || lines_.contains(label);
  }
  /// If there are no volume elements, surface elements become cells of plane strain and lines their faces.
  /// @return whether the mesh is one of plane strain
  bool takePlaneCells();
  struct ElementNodes {
    std::vector<Label> nodes;
    std::size_t place;
  };
  /// Of a cell, surface element or line; no nodes for other numbers.
  ElementNodes nodesOf(Label element) const;
  bool hasNode(Label label) const { return nodes_.contains(label); }
  /// Shape of a cell; refuses other numbers.
  fem::ElementShape shapeOf(Label label, std::size_t place) const;

  /// Faces and lines give node sets too. Meshes and element sets of several shapes get a set for each shape.
  SolidFile finish();

private:
  struct Cell {
    Label label;
    fem::ElementShape shape;
    std::size_t firstNode, place;
    int number = -1;
  };
  struct SurfaceElement {
    Label label;
    SurfaceKind kind;
    std::vector<Label> nodes;
    std::size_t place;
    bool mustFit;
  };
  struct Line {
    std::vector<Label> nodes;
    std::size_t place;
    LineUse use;
  };
  struct Reference {
    Label label;
    int side;
    std::size_t place;
  };
  using References = std::map<SetKey, std::vector<Reference>>;

  int nodeIndex(Label label, std::size_t place) const;
  void requireNew(Label label, std::size_t place) const;
  void nameNodesOfLines();
  std::vector<char> usedNodes();
  void numberNodes(SolidFile& file);
  void dropDuplicates();
  void fillGroups(SolidFile& file);
  std::map<SetKey, std::vector<int>> nodesNamed();
  void fillElementSets(SolidFile& file);
  /// @param nodes  takes the nodes of face sets
  void fillFaceSets(SolidFile& file, std::map<SetKey, std::vector<int>>& nodes);
  std::vector<fem::Face> placedFaces(const class FaceFinder& finder, std::vector<char>& fits);
  template <class Members>
  void settle(const std::map<SetKey, Members>& named, const std::string& kind, std::map<std::string, Members>& sets);
  bool placeFace(const FaceFinder& finder, const SurfaceElement& element, fem::Face& face) const;
  void requireSound(const SolidFile& file) const;

  const TextSource& source_;
  std::vector<Vec3> X_;
  std::vector<Label> nodeLabel_;
  std::vector<int> newNumber_;  ///< of each node of the file, −1 if dropped
  std::unordered_map<Label, std::size_t> nodes_, cells_, faces_;
  std::vector<Cell> cell_;
  std::vector<Label> cellNode_;
  std::vector<SurfaceElement> face_;
  std::unordered_map<Label, Line> lines_;
  bool plane_ = false;
  References nodeSets_, elementSets_, sideSets_;
  std::vector<std::string> notes_;
};

}  // namespace dovetail::solid_io
