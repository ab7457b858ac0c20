// Data files of LAMMPS, read section by section.
#include <algorithm>
#include <array>
#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/core/nearest.hpp"
#include "grain_rows.hpp"

namespace dovetail::grain_io {

namespace {

/// Columns of a line of Atoms, from 0.
struct Columns {
  std::size_t type, diameter, density, position, all;
};

class DataReader {
public:
  DataReader(TextSource& source, Units units) : source_(source), units_(units) {}
  GrainFile read();

private:
  void readTitle();
  void readHeader(std::string_view line, std::size_t at);
  void readBounds(const std::vector<std::string_view>& words, int axis);
  void readSection(const std::string& name, std::string_view style);
  void readAtoms(std::string_view style);
  void readVelocities();
  Columns columnsOf(std::string_view style, std::size_t count, std::size_t at);
  bool nextRow(std::vector<std::string_view>& words, const char* what);
  void requireOrthogonal(const std::vector<std::string_view>& words);
  void addNotes();

  TextSource& source_;
  Units units_;
  std::string named_;
  std::optional<GrainRows> rows_;
  std::optional<std::size_t> atoms_;
  geometry::Box box_{};
  std::array<bool, 3> bounds_{};
  bool haveAtoms_ = false, haveVelocities_ = false, wrapped_ = false;
  std::size_t row_ = 0;
  std::map<std::string, std::size_t> passed_;  ///< sections, with the rows that the header announces
  std::vector<std::string> notes_;
};

/// Text before a comment, and the comment.
std::pair<std::string_view, std::string_view> splitComment(std::string_view line) {
  const std::size_t mark = line.find('#');
  return {trimmed(line.substr(0, mark)),
          mark == std::string_view::npos ? std::string_view{} : trimmed(line.substr(mark + 1))};
}

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Sections that have nothing to do with spheres.
const std::vector<std::string> sections{"Atoms",           "Velocities",       "Masses",          "Bonds",
                                        "Angles",          "Dihedrals",        "Impropers",       "Pair Coeffs",
                                        "PairIJ Coeffs",   "Bond Coeffs",      "Angle Coeffs",    "Dihedral Coeffs",
                                        "Improper Coeffs", "Atom Type Labels", "Bond Type Labels"};

/// Counts of the header that mean particles of other shapes.
constexpr std::array<std::string_view, 4> shapes{"ellipsoids", "lines", "triangles", "bodies"};
constexpr std::array<std::string_view, 15> harmless{"atom types",
                                                    "bonds",
                                                    "angles",
                                                    "dihedrals",
                                                    "impropers",
                                                    "bond types",
                                                    "angle types",
                                                    "dihedral types",
                                                    "improper types",
                                                    "extra bond per atom",
                                                    "extra angle per atom",
                                                    "extra dihedral per atom",
                                                    "extra improper per atom",
                                                    "extra special per atom",
                                                    "crossterms"};

void DataReader::readTitle() {
  const std::string_view title = source_.line();
  constexpr std::string_view mark = "units = ";
  const std::size_t at = title.find(mark);
  if (at == std::string_view::npos) return;
  const std::vector<std::string_view> words = wordsOf(title.substr(at + mark.size()));
  if (!words.empty()) named_ = words.front().substr(0, words.front().find_first_of(",;"));
}

void DataReader::readBounds(const std::vector<std::string_view>& words, int axis) {
  const double low = source_.parseReal(words[0]), high = source_.parseReal(words[1]);
  if (!(low < high)) source_.refuse("the box has no extent", "give the smaller bound first");
  const double length = scaleOf(units_, named_, source_).length;
  box_.lower[axis] = length * low;
  box_.upper[axis] = length * high;
  bounds_[static_cast<std::size_t>(axis)] = true;
}

void DataReader::requireOrthogonal(const std::vector<std::string_view>& words) {
  for (std::size_t k = 0; k < 3; ++k)
    if (source_.parseReal(words[k]) != 0.0)
      source_.refuse("the box is sheared (xy xz yz)", "give one with right angles");
}

void DataReader::readHeader(std::string_view line, std::size_t at) {
  const std::vector<std::string_view> words = wordsOf(line);
  std::size_t numbers = 0;
  double value = 0.0;
  while (numbers < words.size() && io::isNumber(words[numbers], value)) ++numbers;
  std::string key;
  for (std::size_t k = numbers; k < words.size(); ++k) {
    if (!key.empty()) key += ' ';
    key += words[k];
  }
  const bool isOne = numbers == 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (numbers == 2 && key == name + "lo " + name + "hi") return readBounds(words, axis);
  }
  if (numbers == 3 && key == "xy xz yz") return requireOrthogonal(words);
  if (isOne && key == "atoms") {
    const std::int64_t count = source_.parseInteger(words[0]);
    constexpr std::size_t bytesEach = 2 * 7;  // of a line with one digit per number
    if (count < 0 || static_cast<std::uint64_t>(count) > source_.remaining() / bytesEach)
      source_.refuse("it announces " + std::to_string(count) + " atoms, which the file cannot hold",
                     "give a complete file");
    atoms_ = static_cast<std::size_t>(count);
    return;
  }
  if (isOne && std::find(shapes.begin(), shapes.end(), key) != shapes.end()) {
    if (source_.parseInteger(words[0]) != 0) source_.refuse("the file has " + key, "give one with spheres alone");
    return;
  }
  if (isOne && std::find(harmless.begin(), harmless.end(), key) != harmless.end()) {
    const bool told = key == "bonds" || key == "angles" || key == "dihedrals" || key == "impropers";
    if (const std::int64_t count = source_.parseInteger(words[0]); told && count > 0)
      passed_[key] = static_cast<std::size_t>(count);
    return;
  }
  source_.refuseAt(at, "the line is no header of a data file: " + shown(line),
                   "write \"N atoms\", \"xlo xhi\" and so on, or a section such as Atoms");
}

/// The words of the next line with any; false where no row is left.
bool DataReader::nextRow(std::vector<std::string_view>& words, const char* what) {
  if (row_ == *atoms_) return false;
  while (!source_.atEnd()) {
    words = wordsOf(splitComment(source_.line()).first);
    if (words.empty()) continue;
    if (!isLetter(words.front().front())) return ++row_, true;
    break;
  }
  source_.refuse("the section " + std::string(what) + " ends after " + std::to_string(row_) + " of " +
                     std::to_string(*atoms_) + " lines",
                 "give a complete file");
}

Columns DataReader::columnsOf(std::string_view style, std::size_t count, std::size_t at) {
  const auto none = [&](const std::string& problem, const std::string& remedy) {
    source_.refuseAt(at, problem, remedy);
  };
  const std::vector<std::string_view> words = wordsOf(style);
  const std::string_view name = words.empty() ? "" : words.front();
  Columns columns{1, 2, 3, 4, 7};
  if (name == "bpm/sphere") {
    columns = {2, 3, 4, 5, 8};
  } else if (name == "hybrid") {
    std::size_t next = 5;
    bool spheres = false;
    columns = {1, next, next + 1, 2, next + 2};
    for (std::size_t k = 1; k < words.size(); ++k) {
      if (words[k] == "sphere" || words[k] == "granular") {
        columns.diameter = next++;
        columns.density = next++;
        spheres = true;
      } else if (words[k] == "bond" || words[k] == "molecular") {
        ++next;
      } else {
        none("the atom style hybrid has " + shown(words[k]), "use sphere, bond or molecular");
      }
    }
    columns.all = next;
    if (!spheres && words.size() > 1) none("the atom style has no spheres", "use hybrid sphere");
    if (words.size() == 1 && count != 7 && count != 10)
      none("the parts of the atom style hybrid are not named", "write them: \"Atoms # hybrid bond sphere\"");
    if (words.size() == 1) columns.all = 7;
  } else if (!name.empty() && name != "sphere" && name != "granular" && name != "gran") {
    none("the atom style is " + shown(name), "use sphere: other styles have no radius");
  } else if (name.empty()) {
    notes_.emplace_back("The section Atoms does not name its style: it is read as of style sphere.");
  }
  if (count != columns.all && count != columns.all + 3)
    none("a line of Atoms has " + std::to_string(count) + " columns",
         "give " + std::to_string(columns.all) + ", or three more with the periods, for the style " +
             (name.empty() ? "sphere" : std::string(name)));
  return columns;
}

void DataReader::readAtoms(std::string_view style) {
  if (haveAtoms_) source_.refuse("there are two sections Atoms", "give one");
  haveAtoms_ = true;
  rows_.emplace(source_, scaleOf(units_, named_, source_));
  std::optional<Columns> columns;
  std::vector<std::string_view> words;
  std::size_t before = 0;
  for (row_ = 0; nextRow(words, "Atoms"); before = words.size()) {
    const std::size_t at = source_.offset() - 1;
    if (!columns)
      columns = columnsOf(style, words.size(), at);
    else if (words.size() != before)
      source_.refuse(
          "a line of Atoms has " + std::to_string(words.size()) + " columns, that before " + std::to_string(before),
          "give all as many");
    const auto real = [&](std::size_t k) { return source_.parseReal(words[k]); };
    for (std::size_t k = columns->all; k < words.size(); ++k) wrapped_ |= source_.parseInteger(words[k]) != 0;
    rows_->add({.position = {real(columns->position), real(columns->position + 1), real(columns->position + 2)},
                .radius = 0.5 * real(columns->diameter),
                .density = real(columns->density),
                .id = source_.parseInteger(words[0]),
                .type = source_.parseInteger(words[columns->type])});
  }
}

void DataReader::readVelocities() {
  if (!haveAtoms_) source_.refuse("the section Velocities comes before Atoms", "put it behind");
  if (haveVelocities_) source_.refuse("there are two sections Velocities", "give one");
  haveVelocities_ = true;
  std::vector<std::string_view> words;
  for (row_ = 0; nextRow(words, "Velocities");) {
    if (words.size() != 7)
      source_.refuse("a line of Velocities has " + std::to_string(words.size()) + " columns",
                     "give 7: id, velocity and angular velocity");
    std::array<double, 6> v;
    for (std::size_t k = 0; k < 6; ++k) v[k] = source_.parseReal(words[k + 1]);
    rows_->setMotion(source_.parseInteger(words[0]), {v[0], v[1], v[2]}, {v[3], v[4], v[5]});
  }
}

void DataReader::readSection(const std::string& name, std::string_view style) {
  if (std::find(sections.begin(), sections.end(), name) == sections.end())
    source_.refuse("there is no section " + shown(name), adviceFor(name, sections));
  if ((name == "Atoms" || name == "Velocities") && !atoms_)
    source_.refuse("the header does not say how many atoms there are", "write a line such as \"100 atoms\"");
  if (name == "Atoms") return readAtoms(style);
  if (name == "Velocities") return readVelocities();
  while (!source_.atEnd()) {
    const std::size_t begin = source_.offset();
    const std::string_view line = trimmed(source_.line());
    if (!line.empty() && isLetter(line.front())) return source_.goTo(begin);
  }
}

void DataReader::addNotes() {
  for (const auto& [name, count] : passed_)
    notes_.push_back(std::to_string(count) + " " + name + " of the file are not read.");
  if (wrapped_) notes_.emplace_back("Image flags of atoms are not read: spheres are where they are in the box.");
}

GrainFile DataReader::read() {
  readTitle();
  bool header = true;
  while (!source_.atEnd()) {
    const std::size_t at = source_.offset();
    const auto [text, comment] = splitComment(source_.line());
    if (text.empty()) continue;
    if (isLetter(text.front())) {
      header = false;
      readSection(std::string(text), comment);
    } else if (header) {
      readHeader(text, at);
    } else {
      source_.refuse("the line belongs to no section: " + shown(text), "give as many lines as the header says");
    }
  }
  if (!haveAtoms_) throw InputError("the file has no section Atoms", source_.name(), "give a complete data file");
  addNotes();
  rows_->file.notes = notes_;
  if (bounds_[0] && bounds_[1] && bounds_[2]) rows_->file.box = box_;
  return rows_->finish();
}

}  // namespace

GrainFile lammpsData(TextSource& source, Units units) { return DataReader(source, units).read(); }

}  // namespace dovetail::grain_io
