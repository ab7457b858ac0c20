// Text dumps of LAMMPS and LIGGGHTS: snapshots, one after the other.
#include <algorithm>
#include <array>
#include <map>

#include "dovetail/core/error.hpp"
#include "grain_rows.hpp"

namespace dovetail::grain_io {

namespace {

/// Where the lines of a snapshot begin, and what its head says.
struct Snapshot {
  std::size_t begin = 0;  ///< of "ITEM: TIMESTEP", or what comes before it
  std::size_t count = 0, rows = 0;
  std::vector<std::string_view> columns{};
  std::array<double, 3> lower{}, upper{};
  std::array<bool, 3> periodic{};
  bool hasBox = false, hasCount = false;
  std::string_view units{};
  std::optional<double> time{};
};

constexpr const char* breaksOff = "give a complete dump, or take an earlier frame: \"frame\": -2";

class DumpReader {
public:
  DumpReader(TextSource& source, Units units) : source_(source), units_(units) {}
  GrainFile read(std::int64_t frame);

private:
  Snapshot readHead();
  std::optional<Snapshot> headUnlessLast(std::int64_t frame);
  void readItem(Snapshot& head, const std::vector<std::string_view>& words);
  void readBox(Snapshot& head, const std::vector<std::string_view>& words);
  std::size_t passRows(const Snapshot& head);
  void passBlankLines();
  GrainFile readRows(const Snapshot& head);

  TextSource& source_;
  Units units_;
  std::string_view units0_;  ///< named in the first snapshot only
};

void DumpReader::readBox(Snapshot& head, const std::vector<std::string_view>& words) {
  const bool sheared = words.size() > 3 && words[3] == "xy";
  if (words.size() > 3 && words[3] == "abc")
    source_.refuse("the box is not along the axes", "give one with right angles");
  const std::size_t flags = sheared ? 6 : 3;
  for (std::size_t k = 0; k < 3; ++k) {
    head.periodic[k] = words.size() == flags + 3 && words[flags + k] == "pp";
    const std::vector<std::string_view> row = wordsOf(source_.line());
    if (row.size() != (sheared ? 3U : 2U))
      source_.refuse("the bounds of the box are incomplete", "give a complete dump");
    head.lower[k] = source_.parseReal(row[0]);
    head.upper[k] = source_.parseReal(row[1]);
    if (sheared && source_.parseReal(row[2]) != 0.0) source_.refuse("the box is sheared", "give one with right angles");
    if (!(head.lower[k] < head.upper[k])) source_.refuse("the box has no extent", "give the smaller bound first");
  }
  head.hasBox = true;
}

void DumpReader::readItem(Snapshot& head, const std::vector<std::string_view>& words) {
  if (words[1] == "BOX") return readBox(head, words);
  if (words[1] == "NUMBER" && words.size() == 4 && words[3] == "ATOMS") {
    const std::int64_t count = source_.parseInteger(trimmed(source_.line()));
    if (count < 0 || static_cast<std::uint64_t>(count) > source_.remaining())
      source_.refuse("it announces " + std::to_string(count) + " atoms, which the file cannot hold", breaksOff);
    head.count = static_cast<std::size_t>(count);
    head.hasCount = true;
  } else if (words[1] == "TIMESTEP") {
    source_.parseInteger(trimmed(source_.line()));
  } else if (words[1] == "TIME") {
    head.time = source_.parseReal(trimmed(source_.line()));
  } else if (words[1] == "UNITS") {
    head.units = trimmed(source_.line());
  } else {
    source_.refuse("a dump of " + shown(words.back()) + " has no spheres", "give one of atoms: dump … custom");
  }
}

/// Up to the rows. Of what comes twice the last counts.
Snapshot DumpReader::readHead() {
  Snapshot head{.begin = source_.offset()};
  while (head.columns.empty()) {
    if (source_.atEnd()) source_.refuse("the dump breaks off", breaksOff);
    const std::vector<std::string_view> words = wordsOf(source_.line());
    if (words.empty()) continue;
    if (words.size() < 2 || words[0] != "ITEM:")
      source_.refuse("the line belongs to no part of a dump: " + shown(words[0]), "give as many lines as it says");
    if (words[1] != "ATOMS") {
      readItem(head, words);
      continue;
    }
    head.columns.assign(words.begin() + 2, words.end());
    if (head.columns.empty()) source_.refuse("the columns have no names", "write \"ITEM: ATOMS id type x y z radius\"");
  }
  if (!head.hasCount) source_.refuse("the number of atoms is not told", "give a complete dump");
  head.rows = source_.offset();
  return head;
}

/// Nothing where the dump breaks off in a head and a frame before is wanted.
std::optional<Snapshot> DumpReader::headUnlessLast(std::int64_t frame) {
  try {
    return readHead();
  } catch (const InputError&) {
    if (frame >= -1 || !source_.atEnd()) throw;
    return {};
  }
}

/// @return how many there are, which is fewer than the head says where the dump breaks off
std::size_t DumpReader::passRows(const Snapshot& head) {
  for (std::size_t k = 0; k < head.count; ++k) {
    if (source_.atEnd()) return k;
    source_.endLine();
  }
  return head.count;
}

void DumpReader::passBlankLines() {
  while (!source_.atEnd()) {
    const std::size_t begin = source_.offset();
    if (!trimmed(source_.line()).empty()) return source_.goTo(begin);
  }
}

/// Columns by name; those that nothing is made of are told.
class Names {
public:
  Names(const Snapshot& head, const TextSource& source) : head_(head), source_(source) {
    for (std::size_t k = 0; k < head.columns.size(); ++k) place_.try_emplace(head.columns[k], k);
  }
  std::optional<std::size_t> find(std::string_view name) {
    const auto found = place_.find(name);
    if (found == place_.end()) return {};
    used_.push_back(found->first);
    return found->second;
  }
  /// All three, or none. @throws InputError if there is one without the others
  std::optional<std::array<std::size_t, 3>> three(const std::array<std::string_view, 3>& names) {
    std::array<std::optional<std::size_t>, 3> found;
    for (std::size_t k = 0; k < 3; ++k) found[k] = find(names[k]);
    if (!found[0] && !found[1] && !found[2]) return {};
    for (std::size_t k = 0; k < 3; ++k)
      if (!found[k]) source_.refuseAt(head_.rows - 1, "there is no column " + std::string(names[k]), "dump all three");
    return std::array<std::size_t, 3>{*found[0], *found[1], *found[2]};
  }
  std::string unused() const {
    std::string text;
    for (const auto& [name, place] : place_) {
      if (std::find(used_.begin(), used_.end(), name) != used_.end()) continue;
      if (!text.empty()) text += ", ";
      text += shown(name);
    }
    return text;
  }
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const {
    source_.refuseAt(head_.rows - 1, problem, remedy);
  }

private:
  const Snapshot& head_;
  const TextSource& source_;
  std::map<std::string_view, std::size_t> place_;
  std::vector<std::string_view> used_;
};

/// Where in a row what is read stands.
struct Layout {
  std::array<std::size_t, 3> position{};
  bool scaled = false;
  std::optional<std::size_t> radius, diameter, density, mass, id, type, clump;
  std::optional<std::array<std::size_t, 3>> velocity, spin;
};

Layout layoutOf(Names& names) {
  Layout layout;
  bool found = false;
  for (const char* const ending : {"", "u", "s", "su"}) {
    std::array<std::string, 3> words{"x", "y", "z"};
    for (std::string& word : words) word += ending;
    const auto place = names.three({words[0], words[1], words[2]});
    if (!place || found) continue;
    layout.position = *place;
    layout.scaled = ending[0] == 's';
    found = true;
  }
  if (!found) names.refuse("there are no positions", "dump x y z");
  for (const char* const shape : {"shapex", "blockiness1", "c_shape[1]", "quatw", "quat1"})
    if (names.find(shape)) names.refuse("the column " + shown(shape) + " is of other shapes", "dump spheres");
  layout.radius = names.find("radius");
  layout.diameter = names.find("diameter");
  if (!layout.radius && !layout.diameter) names.refuse("there are no radii", "dump radius");
  layout.density = names.find("density");
  layout.mass = names.find("mass");
  layout.id = names.find("id");
  layout.type = names.find("type");
  layout.clump = names.find("id_multisphere");
  layout.velocity = names.three({"vx", "vy", "vz"});
  layout.spin = names.three({"omegax", "omegay", "omegaz"});
  return layout;
}

Row rowOf(const std::vector<std::string_view>& words, const Layout& layout, const Snapshot& head,
          const TextSource& source) {
  const auto real = [&](std::size_t c) { return source.parseReal(words[c]); };
  const auto vector = [&](const std::array<std::size_t, 3>& c) { return Vec3{real(c[0]), real(c[1]), real(c[2])}; };
  Row row{.position = vector(layout.position),
          .radius = layout.radius ? real(*layout.radius) : 0.5 * real(*layout.diameter)};
  for (std::size_t c = 0; layout.scaled && c < 3; ++c) {
    double& x = row.position[static_cast<int>(c)];
    x = head.lower[c] + x * (head.upper[c] - head.lower[c]);
  }
  if (layout.density)
    row.density = real(*layout.density);
  else if (layout.mass)
    row.density = densityOf(real(*layout.mass), row.radius);
  if (layout.velocity) row.velocity = vector(*layout.velocity);
  if (layout.spin) row.spin = vector(*layout.spin);
  if (layout.id) row.id = source.parseInteger(words[*layout.id]);
  if (layout.type) row.type = source.parseInteger(words[*layout.type]);
  if (layout.clump && real(*layout.clump) >= 0.0)
    source.refuse("the sphere is a part of a multisphere", "give single spheres: clumps would come apart");
  return row;
}

GrainFile DumpReader::readRows(const Snapshot& head) {
  const Scale scale = scaleOf(units_, head.units.empty() ? units0_ : head.units, source_);
  Names names(head, source_);
  const Layout layout = layoutOf(names);
  if (layout.scaled && !head.hasBox) names.refuse("positions are fractions of a box that is not told", "dump x y z");
  GrainRows rows(source_, scale);
  for (std::size_t k = 0; k < head.count; ++k) {
    const std::vector<std::string_view> words = wordsOf(source_.line());
    if (words.size() != head.columns.size())
      source_.refuse("a row has " + std::to_string(words.size()) + " values",
                     "give " + std::to_string(head.columns.size()) + ", one per column");
    rows.add(rowOf(words, layout, head, source_));
  }
  if (const std::string unused = names.unused(); !unused.empty())
    rows.file.notes.push_back("Columns of the dump that are not read: " + unused + ".");
  if (head.time) rows.file.time = scale.time * *head.time;
  if (head.hasBox) {
    const auto& [a, b] = std::pair(head.lower, head.upper);
    rows.file.box = {scale.length * Vec3{a[0], a[1], a[2]}, scale.length * Vec3{b[0], b[1], b[2]}};
    rows.file.periodic = head.periodic;
  }
  return rows.finish();
}

GrainFile DumpReader::read(std::int64_t frame) {
  std::vector<std::size_t> begins;
  const auto isWanted = [&] { return frame >= 0 && static_cast<std::int64_t>(begins.size()) > frame; };
  for (passBlankLines(); !source_.atEnd() && !isWanted(); passBlankLines()) {
    begins.push_back(source_.offset());
    const std::optional<Snapshot> whole = headUnlessLast(frame);
    if (!whole) break;
    const Snapshot& head = *whole;
    if (begins.size() == 1) units0_ = head.units;
    if (const std::size_t count = passRows(head); count < head.count && (frame == -1 || isWanted()))
      source_.refuse(
          "the dump breaks off after " + std::to_string(count) + " of " + std::to_string(head.count) + " atoms",
          breaksOff);
  }
  source_.goTo(begins[frameAt(frame, begins.size(), source_.name())]);
  return readRows(readHead());
}

}  // namespace

GrainFile lammpsDump(TextSource& source, Units units, std::int64_t frame) {
  return DumpReader(source, units).read(frame);
}

}  // namespace dovetail::grain_io
