// Entities, nodes and elements of MSH 4.1 and 2.2 (Gmsh reference manual, "File formats").
#include "gmsh_reader.hpp"

namespace dovetail::solid_io {

namespace {

Vec3 readPoint(TextSource& source) {
  Vec3 X;
  for (int i = 0; i < 3; ++i) X[i] = source.real();
  return X;
}

}  // namespace

void GmshReader::readEntities4() {
  std::array<std::size_t, 4> counts{};
  for (std::size_t& count : counts) count = source_.count(8, 8);
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::size_t k = 0; k < counts[static_cast<std::size_t>(dimension)]; ++k) readEntity4(dimension);
}

void GmshReader::readEntity4(int dimension) {
  const std::int64_t tag = source_.integer(4);
  for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) source_.real();  // its place, or its bounding box
  std::vector<std::int64_t>& groups = groupsOfEntity_[{dimension, tag}];
  const std::size_t count = source_.count(8, source_.binary ? 4 : 2);
  for (std::size_t k = 0; k < count; ++k) groups.push_back(source_.integer(4));
  if (dimension == 0) return;
  const std::size_t bounds = source_.count(8, source_.binary ? 4 : 2);
  for (std::size_t k = 0; k < bounds; ++k) source_.integer(4);
}

void GmshReader::readNodes4() {
  const std::size_t blocks = source_.count(8, 6);
  for (int k = 0; k < 3; ++k) source_.integer(8);
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::int64_t dimension = source_.integer(4);
    source_.integer(4);
    const std::int64_t parametric = source_.integer(4);
    if (dimension < 0 || dimension > 3 || (parametric != 0 && parametric != 1))
      source_.refuse("a block of nodes is not one of an entity", "give a complete file");
    const std::size_t count = source_.count(8, 8);
    std::vector<std::pair<Label, std::size_t>> tags;
    for (std::size_t k = 0; k < count; ++k) {
      const Label tag = source_.integer(8);
      tags.emplace_back(tag, source_.offset());
    }
    for (const auto& [tag, place] : tags) {
      builder_.addNode(tag, readPoint(source_), place);
      for (std::int64_t k = 0; k < parametric * dimension; ++k) source_.real();
    }
  }
}

void GmshReader::readElements4() {
  const std::size_t blocks = source_.count(8, 6);
  for (int k = 0; k < 3; ++k) source_.integer(8);
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::int64_t dimension = source_.integer(4), entity = source_.integer(4);
    const GmshType& type = requireType(source_.integer(4));
    if (dimension != type.dimension)
      source_.refuse("elements of an entity of dimension " + std::to_string(dimension) + " have dimension " +
                         std::to_string(type.dimension),
                     "give a complete file");
    const std::size_t count = source_.count(8, 4);
    for (std::size_t k = 0; k < count; ++k) {
      const Label label = source_.integer(8);
      readElement(type, label, source_.offset(), 0, entity);
    }
  }
}

void GmshReader::readNodes2() {
  const bool binary = std::exchange(source_.binary, false);
  const std::size_t count = source_.count(0, 8);
  source_.endLine();
  source_.binary = binary;
  for (std::size_t k = 0; k < count; ++k) {
    const Label label = source_.integer(4);
    const std::size_t place = source_.offset();
    builder_.addNode(label, readPoint(source_), place);
  }
}

void GmshReader::readElements2() {
  const bool binary = std::exchange(source_.binary, false);
  const std::size_t total = source_.count(0, 4);
  source_.endLine();
  source_.binary = binary;
  for (std::size_t done = 0; done < total;) {
    if (!binary) {
      readElementBlock2(0, 1, 0);
      ++done;
      continue;
    }
    const std::int64_t code = source_.integer(4);
    const std::size_t count = source_.count(4, 4), tags = source_.count(4, 4);
    if (count == 0 || count > total - done)
      source_.refuse("a block of elements has " + std::to_string(count), "give a complete file whose counts are right");
    readElementBlock2(code, count, tags);
    done += count;
  }
}

/// @param code, tags  of a binary block; in ASCII every element brings its own
void GmshReader::readElementBlock2(std::int64_t code, std::size_t count, std::size_t tags) {
  for (std::size_t k = 0; k < count; ++k) {
    const Label label = source_.integer(4);
    const std::size_t place = source_.offset();
    if (!source_.binary) {
      code = source_.integer(4);
      tags = source_.count(4, 2);
    }
    const GmshType& type = requireType(code);
    std::array<std::int64_t, 2> groupAndEntity{};
    for (std::size_t t = 0; t < tags; ++t) {
      const std::int64_t tag = source_.integer(4);
      if (t < 2) groupAndEntity[t] = tag;
    }
    readElement(type, label, place, groupAndEntity[0], groupAndEntity[1]);
  }
}

void GmshReader::readElement(const GmshType& type, Label label, std::size_t place, std::int64_t group,
                             std::int64_t entity) {
  elements_.push_back({&type, label, elementNodes_.size(), place, group, entity});
  for (int k = 0; k < type.nodes; ++k) elementNodes_.push_back(source_.integer(version4_ ? 8 : 4));
}

}  // namespace dovetail::solid_io
