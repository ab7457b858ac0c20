// The sections of an MSH file, one reader per version.
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "gmsh_types.hpp"
#include "mesh_builder.hpp"

namespace dovetail::solid_io {

/// What the sections of a file tell each other.
class GmshReader {
public:
  explicit GmshReader(TextSource& source) : source_(source), builder_(source) {}
  SolidFile read();

private:
  using Group = std::pair<int, std::int64_t>;  // dimension and number

  void readFormat();
  void readSection(const std::string& section);
  void readPhysicalNames();
  void readEntities4();
  void readEntity4(int dimension);
  void readNodes4();
  void readElements4();
  void readNodes2();
  void readElements2();
  void readElementBlock2(std::int64_t code, std::size_t count, std::size_t tags);
  const GmshType& requireType(std::int64_t code);

  struct Element {
    const GmshType* type;
    Label label;
    std::size_t firstNode, place;
    std::int64_t group, entity;  ///< group: of version 2, 0 if there is none
  };
  /// Reads its nodes.
  void readElement(const GmshType& type, Label label, std::size_t place, std::int64_t group, std::int64_t entity);
  std::span<const Label> nodesOf(const Element& element) const;

  /// What elements are and what they belong to, once all sections are read: they may stand in any order.
  void giveElements();
  std::vector<std::int64_t> groupsOf(const Element& element) const;
  void giveElement(const Element& element, bool grouped);
  void addToSet(const Element& element, const SetKey& set);
  SetKey keyOf(const Group& group) const;
  static SetKey keyOfEntity(const Element& element);
  void noteSharedNames(const std::set<Group>& used);

  TextSource& source_;
  MeshBuilder builder_;
  bool version4_ = false, binary_ = false;
  std::map<Group, std::string> names_;
  std::map<Group, std::vector<std::int64_t>> groupsOfEntity_;
  std::vector<Element> elements_;
  std::vector<Label> elementNodes_;
  std::set<std::string> seen_;
};

}  // namespace dovetail::solid_io
