// The cards of an INP file, one source file per kind.
#pragma once

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "abaqus_types.hpp"
#include "inp_cards.hpp"
#include "mesh_builder.hpp"

namespace dovetail::solid_io {

/// Nodes, elements, sets and surfaces of a part have numbers and names of their own; `model` is all that stands outside
/// of it: the assembly, or a file without parts.
enum class Space { model, part };

/// Members are the same wherever the file names them.
struct Member {
  Label label;
  Space space;
  std::size_t place;
  auto operator<=>(const Member& other) const { return std::tie(label, space) <=> std::tie(other.label, other.space); }
  bool operator==(const Member& other) const { return label == other.label && space == other.space; }
};

/// first, first + step, … up to last, as GENERATE has it.
struct LabelRange {
  Label first, last, step;
  Space space;
  std::size_t place;
  auto operator<=>(const LabelRange&) const = default;
};

/// Space, and name in lower case.
using SetName = std::pair<Space, std::string>;

/// A set of labels, and the spelling its name was first given in. Ranges are counted out when all that they may name
/// has been read: until then a line of a file could stand for any number of labels.
struct LabelSet {
  std::string name;
  std::vector<Member> members;
  std::vector<LabelRange> ranges;
  std::vector<SetName> elementSets;  ///< whose nodes are in this one
};
using LabelSets = std::map<SetName, LabelSet>;

class AbaqusReader {
public:
  explicit AbaqusReader(TextSource& source) : source_(source), cards_(source), builder_(source) {}
  SolidFile read();

private:
  struct SurfaceLine {
    SetName surface;
    std::string name, item, face;
    bool ofNodes;
    std::size_t place;
  };

  void readCard(const std::string& keyword);
  void readOther(const std::string& keyword);
  void readNodes();
  void readElements();
  void addElement(const std::string& name, const AbaqusType& type, std::span<const Label> numbers, std::size_t place);
  void readSection();
  void noteWhatWasDropped();

  // Parts and their instances
  void enterPart();
  void enterInstance();
  void requireUnmoved();
  void leavePart();
  Space space() const { return inPart_ ? Space::part : Space::model; }
  /// Where the labels of a card are: that of its INSTANCE, or of the card.
  Space spaceOfCard() const;
  /// "Part-1-1." in front of a name or number.
  bool takeInstance(std::string& name) const;
  /// Gives nodes and elements of the assembly numbers of ours, which those of the part cannot have.
  Label newLabel(std::map<Label, Label>& aliases, Label label, const char* what, std::size_t place);
  Label labelOf(const std::map<Label, Label>& aliases, const Member& member) const;
  static void nameAsInFile(const std::map<Label, Label>& aliases, std::vector<std::int64_t>& numbers);

  // Sets and surfaces
  LabelSet& setOf(LabelSets& sets, const std::string& name);
  void readSet(LabelSets& sets, const std::string& parameter);
  void readMember(const LabelSets& sets, LabelSet& set, std::string field, Space space);
  void addRange(LabelSet& set, const std::vector<std::string_view>& fields, Space space);
  void addOther(LabelSet& set, const LabelSet& other);
  const LabelSet* find(const LabelSets& sets, Space space, std::string name) const;
  void countOut(LabelSets& sets, std::size_t existing, const std::string& what);
  void addNodesOfElements(LabelSet& set);
  template <class Entry>
  std::string nameOf(const SetName& key, const std::string& name, const std::map<SetName, Entry>& others,
                     const std::string& what);
  void giveSets();
  void keepSurface();
  std::vector<Label> labelsOf(const LabelSets& sets, const std::map<Label, Label>& aliases, const SurfaceLine& line);
  void readSurfaces();
  void readSurface(const SurfaceLine& line, const SetKey& key);

  TextSource& source_;
  InpCards cards_;
  MeshBuilder builder_;
  int parts_ = 0, instances_ = 0;
  bool inPart_ = false;
  std::string part_, instance_;
  std::map<Label, Label> nodeAliases_, elementAliases_;
  LabelSets nodeSets_, elementSets_;
  std::map<SetName, std::string> surfaces_;
  std::vector<SurfaceLine> surfaceLines_;
  std::set<std::string> passedOver_, constraints_, variants_, planeVariants_, ignored_, thicknesses_;
  std::map<std::string, std::size_t> faces_, lines_;  ///< elements by their type
};

/// Digits and signs alone.
bool isNumber(std::string_view field);
std::string unquoted(std::string_view field);

}  // namespace dovetail::solid_io
