// Restart files of MercuryDPM: a head, then sections "Species", "Walls", "Boundaries", "Particles" and "Interactions"
// with the number of their items. An item is a line, its kind and then keys with their values.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "dovetail/core/error.hpp"
#include "grain_rows.hpp"

namespace dovetail::grain_io {

namespace {

using Words = std::vector<std::string_view>;

constexpr std::array<std::string_view, 6> sectionNames{"Species",    "Walls",     "WallsPeriodic",
                                                       "Boundaries", "Particles", "Interactions"};

constexpr const char* whole = "give a whole restart file of MercuryDPM 1.0 or later";

class RestartReader {
public:
  explicit RestartReader(TextSource& source) : source_(source), rows_(source, {}) {}
  GrainFile read();

private:
  bool startSection(const Words& words);
  void readHead(const Words& words);
  void readSpecies(const Words& words);
  void readParticle(const Words& words);
  void readBoundary(const Words& words);
  void addNotes();
  /// Of those behind a key; empty, or nothing, if the key is not there.
  std::string_view wordOf(const Words& words, std::string_view key, std::size_t which = 0) const;
  std::optional<double> valueOf(const Words& words, std::string_view key, std::size_t which = 0) const;
  std::int64_t integerOf(const Words& words, std::string_view key) const;
  double need(const Words& words, std::string_view key, std::size_t which = 0) const;
  Vec3 vectorOf(const Words& words, std::string_view key) const;

  TextSource& source_;
  GrainRows rows_;
  std::string section_;
  std::size_t announced_ = 0, met_ = 0, fixed_ = 0;
  bool haveParticles_ = false, flat_ = false;
  std::map<std::int64_t, double> density_;             ///< of the species, by their ids
  std::map<std::string, std::size_t> walls_, others_;  ///< kinds that are not read
  geometry::Box box_{};
  std::array<bool, 3> periodic_{};
  int bounds_ = 0;
};

std::string_view RestartReader::wordOf(const Words& words, std::string_view key, std::size_t which) const {
  const auto found = std::find(words.begin(), words.end(), key);
  const auto place = static_cast<std::size_t>(found - words.begin()) + 1 + which;
  if (found == words.end()) return {};
  if (place >= words.size()) source_.refuse("there are too few numbers behind " + std::string(key), whole);
  return words[place];
}

std::optional<double> RestartReader::valueOf(const Words& words, std::string_view key, std::size_t which) const {
  const std::string_view word = wordOf(words, key, which);
  if (word.empty()) return {};
  return source_.parseReal(word);
}

std::int64_t RestartReader::integerOf(const Words& words, std::string_view key) const {
  const std::string_view word = wordOf(words, key);
  if (word.empty()) source_.refuse("the line has no " + std::string(key), whole);
  return source_.parseInteger(word);
}

double RestartReader::need(const Words& words, std::string_view key, std::size_t which) const {
  const std::optional<double> value = valueOf(words, key, which);
  if (!value) source_.refuse("the line has no " + std::string(key), whole);
  return *value;
}

Vec3 RestartReader::vectorOf(const Words& words, std::string_view key) const {
  return {need(words, key, 0), need(words, key, 1), need(words, key, 2)};
}

bool RestartReader::startSection(const Words& words) {
  if (words.size() != 2 || std::find(sectionNames.begin(), sectionNames.end(), words[0]) == sectionNames.end())
    return false;
  if (section_ == "Particles" && met_ < announced_)
    source_.refuse("there are " + std::to_string(met_) + " particles, not " + std::to_string(announced_), whole);
  const std::int64_t count = source_.parseInteger(words[1]);
  if (count < 0 || static_cast<std::uint64_t>(count) > source_.remaining())
    source_.refuse("it announces " + std::to_string(count) + " items, which the file cannot hold", whole);
  section_ = words[0];
  announced_ = static_cast<std::size_t>(count);
  met_ = 0;
  haveParticles_ |= section_ == "Particles";
  return true;
}

void RestartReader::readHead(const Words& words) {
  for (int c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    if (const auto low = valueOf(words, axis + "Min")) box_.lower[c] = *low, ++bounds_;
    if (const auto high = valueOf(words, axis + "Max")) box_.upper[c] = *high, ++bounds_;
  }
  if (const auto time = valueOf(words, "time")) rows_.file.time = *time;
  if (const auto dimensions = valueOf(words, "particleDimensions")) flat_ = *dimensions == 2.0;
}

void RestartReader::readSpecies(const Words& words) {
  if (const auto density = valueOf(words, "density")) density_[integerOf(words, "id")] = *density;
}

void RestartReader::readParticle(const Words& words) {
  if (++met_ > announced_) return;  // a template that some versions write behind an empty list
  if (words[0] != "SphericalParticle" && words[0] != "BaseParticle" && words[0] != "ThermalParticle")
    source_.refuse("the particle is of the kind " + shown(words[0]), "give spheres: SphericalParticle");
  Row row{.position = vectorOf(words, "position"),
          .radius = need(words, "radius"),
          .velocity = vectorOf(words, "velocity"),
          .spin = vectorOf(words, "angularVelocity"),
          .id = integerOf(words, "id"),
          .type = integerOf(words, "indSpecies")};
  const std::optional<double> inverseMass = valueOf(words, "invMass");
  fixed_ += inverseMass && *inverseMass == 0.0;
  if (const auto found = density_.find(*row.type); found != density_.end())
    row.density = found->second;
  else if (inverseMass && *inverseMass > 0.0 && !flat_)
    row.density = densityOf(1.0 / *inverseMass, row.radius);
  else
    source_.refuse("the species " + std::to_string(*row.type) + " of the particle is not there", whole);
  rows_.add(row);
}

void RestartReader::readBoundary(const Words& words) {
  if (words[0] != "PeriodicBoundary") {
    ++others_[std::string(words[0])];
    return;
  }
  const Vec3 normal = vectorOf(words, "normal");
  for (int c = 0; c < 3; ++c) {
    if (norm(normal) != std::abs(normal[c]) || normal[c] == 0.0) continue;
    box_.lower[c] = need(words, "distanceLeft");
    box_.upper[c] = need(words, "distanceRight");
    periodic_[static_cast<std::size_t>(c)] = true;
    return;
  }
  ++others_["PeriodicBoundary across the axes"];
}

void RestartReader::addNotes() {
  const auto list = [](const std::map<std::string, std::size_t>& kinds) {
    std::string text;
    for (const auto& [kind, count] : kinds) {
      if (!text.empty()) text += ", ";
      text += std::to_string(count) + " " + shown(kind);
    }
    return text;
  };
  std::vector<std::string>& notes = rows_.file.notes;
  if (!walls_.empty()) notes.push_back("WARNING: Walls of the file are not read: " + list(walls_) + ".");
  if (!others_.empty()) notes.push_back("WARNING: Boundaries of the file are not read: " + list(others_) + ".");
  if (fixed_ > 0)
    notes.push_back("WARNING: " + counted(fixed_, "particle is", "particles are") +
                    " fixed in the file (invMass 0), and free here: give their group a drive.");
  if (flat_) notes.emplace_back("The particles of the file are discs: they are read as spheres of their density.");
}

GrainFile RestartReader::read() {
  while (!source_.atEnd()) {
    const Words words = wordsOf(source_.line());
    if (words.empty() || startSection(words)) continue;
    const bool isItem = static_cast<unsigned char>(words[0].front()) >= 'A' && words[0].front() <= 'Z';
    if (section_.empty()) readHead(words);
    if (section_ == "Species") readSpecies(words);
    if (section_ == "Walls" && isItem) ++walls_[std::string(words[0])];
    if (section_ == "Boundaries" && isItem) readBoundary(words);
    if (section_ == "Particles") readParticle(words);
  }
  if (!haveParticles_) throw InputError("the file has no section Particles", source_.name(), whole);
  if (section_ == "Particles" && met_ < announced_)
    source_.refuse(
        "the file breaks off after " + std::to_string(met_) + " of " + std::to_string(announced_) + " particles",
        whole);
  addNotes();
  if (bounds_ == 6) {
    rows_.file.box = box_;
    rows_.file.periodic = periodic_;
  }
  return rows_.finish();
}

}  // namespace

GrainFile mercuryRestart(TextSource& source) { return RestartReader(source).read(); }

}  // namespace dovetail::grain_io
