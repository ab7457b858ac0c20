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
  explicit GmshReader(Source& source) : source_(source), builder_(source) {}
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
  void addElement(const GmshType& type, Label label, std::span<const Label> nodes, std::size_t place,
                  std::span<const std::int64_t> physical, std::int64_t entity);
  void addToSet(const GmshType& type, Label label, std::span<const Label> nodes, std::size_t place, const SetKey& key);
  /// Elements with the sets that their entities stand for, once all groups are known.
  void nameEntities();
  const GmshType& requireType(std::int64_t code);
  SetKey keyOf(int dimension, std::int64_t group) const;

  struct Unnamed {
    const GmshType* type;
    Label label;
    std::vector<Label> nodes;
    std::size_t place;
    std::int64_t entity;
  };

  Source& source_;
  MeshBuilder builder_;
  bool version4_ = false, binary_ = false, anyGroup_ = false;
  std::map<Group, std::string> names_;
  std::map<Group, std::vector<std::int64_t>> groupsOfEntity_;
  std::vector<Unnamed> unnamed_;
  std::set<std::string> seen_;
};

}  // namespace dovetail::solid_io
