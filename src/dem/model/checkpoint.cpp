#include "dovetail/dem/model/checkpoint.hpp"

#include <concepts>
#include <type_traits>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "events.hpp"

namespace dovetail::dem {

template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, Step>
void archiveFields(Archive& archive, T& step) {
  archive(step.time, step.dt, step.number, step.closing, step.moved, step.timeless);
}

namespace {

constexpr const char* checkpointKind = "dem model 8";

std::vector<char> parametersOf(const Model& m) {
  ByteWriter writer;
  if (m.laws) m.laws->saveParameters(writer);
  return writer.bytes();
}

template <class Archive, class P>
void archiveParticles(Archive& archive, P& p) {
  forEachArray(p, [&](auto& values) { archive(values); });
  archive(p.nextId, p.revision, p.wraps);
}

void archivePairs(ByteWriter& writer, const Model& m) { m.pairs.save(writer); }
void archivePairs(ByteReader& reader, Model& m) {
  m.pairs.setReach(reachOfPairs(m));  // the file does not hold it: it follows from the laws
  m.pairs.load(reader);
}

/// @param last  of the enumeration, which counts from 0
template <class Enumeration>
void requireKnown(Enumeration value, Enumeration last, const char* what) {
  const int number = static_cast<int>(value);
  if (number < 0 || number > static_cast<int>(last))
    throw InputError(std::string(what) + " has the number " + std::to_string(number) + ", which is unknown",
                     "checkpoint", "take an older checkpoint");
}

template <class Archive, class M>
void archiveScene(Archive& archive, M& m) {
  archiveParticles(archive, m.particles);
  archivePairs(archive, m);
  archive(m.gravity, m.rotation, m.booking, m.sortEvery, m.refusesUnstableSteps);
  std::int64_t forcesOf = hasForces(m) || m.forcesOf == Model::never ? m.forcesOf : Model::outdated;
  archive(m.time, m.steps, m.open, m.step, m.work, m.booked, m.rate, m.entered, m.left, forcesOf, m.knownIds,
          m.smallestRadius, m.timeBase, m.stepsBase, m.checkedStep, m.listUpdates);
  if constexpr (Archive::reads) {
    m.forcesOf = forcesOf;
    requireKnown(m.rotation, Rotation::off, "the rotation of grains");
    requireKnown(m.booking, Booking::off, "the booking of energies");
  }
}

void saveDomain(ByteWriter& writer, const Model& m) {
  const Domain domain = m.domain.value_or(Domain{});
  writer(m.domain.has_value(), domain.box, domain.policy);
}

void loadDomain(ByteReader& reader, Model& m) {
  bool there = false;
  Domain domain;
  reader(there, domain.box, domain.policy);
  requireKnown(domain.policy, EscapePolicy::remove, "what becomes of grains that leave");
  m.domain = there ? std::optional(domain) : std::nullopt;
}

/// An empty term of a kind that the library knows; null if it is code.
std::unique_ptr<Term> emptyTerm(const std::string& name) {
  if (name == "walls") return std::make_unique<PrimitiveWallTerm>(PrimitiveWall{});
  if (name == "mesh walls") return std::make_unique<MeshWallTerm>(MeshWall{});
  if (name == "bonds") return std::make_unique<BondTerm>();
  if (name == "damping") return std::make_unique<DampingTerm>();
  if (name == "bodies") return std::make_unique<BodyTerm>();
  if (name == "outlet") return std::make_unique<OutletTerm>();
  return nullptr;
}

[[noreturn]] void refuse(const std::string& problem, const std::string& path, const std::string& remedy) {
  throw InputError(problem, path, remedy);
}

void saveTerms(ByteWriter& writer, const Model& m) {
  writer(static_cast<std::uint64_t>(m.terms.size()));
  for (const auto& term : m.terms) {
    ByteWriter own;
    term->save(own);
    writer(term->name(), term->code(), own.bytes());
  }
}

std::vector<TermOfState> readTerms(ByteReader& reader) {
  std::uint64_t count = 0;
  reader(count);
  std::vector<TermOfState> terms;
  for (std::uint64_t k = 0; k < count; ++k) {
    TermOfState& term = terms.emplace_back();
    reader(term.name, term.code, term.bytes);
  }
  return terms;
}

/// Terms that no code stands behind, empty.
Terms makeTerms(const std::vector<TermOfState>& saved, const std::string& path) {
  Terms terms;
  for (const TermOfState& s : saved) {
    auto term = s.code.empty() ? emptyTerm(s.name) : nullptr;
    if (!term)
      refuse("'" + s.name + "' needs code, which no file can hold: " + s.code, path,
             "set the model up with all its terms before reading");
    terms.add(std::move(term));
  }
  return terms;
}

void requireSameTerms(const std::vector<TermOfState>& saved, const Terms& here, const std::string& path) {
  constexpr const char* remedy = "set the model up as it was when the checkpoint was written";
  auto term = here.begin();
  for (const TermOfState& s : saved) {
    if (term == here.end()) refuse("the model lacks '" + s.name + "' of the checkpoint", path, remedy);
    if ((*term)->name() != s.name)
      refuse("the checkpoint has '" + s.name + "' where the model has '" + (*term)->name() + "'", path, remedy);
    if ((*term)->code() != s.code)
      refuse("'" + s.name + "' was saved with " + (s.code.empty() ? "nothing given as code" : s.code) +
                 ", the model's has " + ((*term)->code().empty() ? "nothing" : (*term)->code()),
             path, remedy);
    ++term;
  }
  if (term != here.end()) refuse("the model has '" + (*term)->name() + "', the checkpoint has not", path, remedy);
}

void loadTerms(const std::vector<TermOfState>& saved, const Terms& terms, const std::string& path) {
  auto term = terms.begin();
  for (const TermOfState& s : saved) {
    ByteReader reader(s.bytes);
    (*term++)->load(reader);
    if (!reader.atEnd())
      refuse("'" + s.name + "' of the checkpoint has more data than this version reads", path,
             "read it with the version that wrote it");
  }
}

void requireSameLaws(ByteReader& reader, const Model& m, const std::string& path) {
  std::string name;
  std::vector<char> parameters;
  reader(name, parameters);
  const std::string here = m.laws ? m.laws->name() : "none";
  if (name != here)
    refuse("the checkpoint was written under the laws '" + name + "', the model has '" + here + "'", path,
           "set the laws that wrote it");
  if (parameters != parametersOf(m))
    refuse("the parameters of the laws '" + here + "' are not those of the checkpoint", path,
           "set the laws that wrote it");
}

/// Of arrays that runs compute with before they look at them.
void requireNumbers(const Particles& particles) {
  validate(particles);
  for (const auto* const field : {&particles.f, &particles.torque})
    for (const Vec3& value : *field)
      if (!isFinite(value))
        throw InputError("a force or torque is not finite", "particles of a checkpoint", "take an older checkpoint");
}

/// All of a state behind its laws but its terms, into `restored`, a copy of the model that it is for. Returns the
/// terms.
std::vector<TermOfState> readContent(ByteReader& reader, const std::string& path, Model& restored) {
  archiveScene(reader, restored);
  requireNumbers(restored.particles);
  loadDomain(reader, restored);
  std::vector<TermOfState> terms = readTerms(reader);
  if (!reader.atEnd()) refuse("the file has more data than a model", path, "give a checkpoint of this version");
  return terms;
}

std::vector<TermOfState> readModel(const std::vector<char>& bytes, const std::string& path, Model& restored) {
  ByteReader reader(bytes);
  requireSameLaws(reader, restored, path);
  return readContent(reader, path, restored);
}

}  // namespace

Model contentOf(const std::vector<char>& bytes, const std::string& path) {
  ByteReader reader(bytes);
  std::string laws;
  std::vector<char> parameters;
  reader(laws, parameters);
  Model content;
  readContent(reader, path, content);
  return content;
}

std::vector<char> saveState(const Model& m) {
  ByteWriter writer;
  writer(m.laws ? m.laws->name() : "none", parametersOf(m));
  archiveScene(writer, m);
  saveDomain(writer, m);
  saveTerms(writer, m);
  return writer.bytes();
}

void writeCheckpoint(const std::filesystem::path& path, const Model& m) {
  writeChecked(path, checkpointKind, saveState(m));
}

void readCheckpoint(const std::filesystem::path& path, Model& m) {
  loadState(readChecked(path, checkpointKind), path.string(), m);
}

void loadGrains(const std::vector<char>& bytes, const std::string& path, Model& m) {
  if (m.particles.size() > 0) refuse("the model holds particles already", path, "load into an empty one");
  Model saved = m;
  for (const TermOfState& term : readModel(bytes, path, saved))
    if (term.name == "bodies" || term.name == "bonds")
      refuse("the state has " + term.name + ", which cannot be read with the grains alone", path,
             "take the state of a run without them");
  if (!saved.particles.weight.empty())
    refuse("grains of the state have weights of an overlap", path, "take the state of a run without overlaps");
  if (!(saved.pairs.periodicity() == m.pairs.periodicity()))
    refuse("the periodic space of the state differs", path, "give the model the same periodic box and axes");
  m.particles = std::move(saved.particles);
  m.pairs = std::move(saved.pairs);
}

PartsOfState partsOf(const std::vector<char>& bytes, const std::string& path, const Model& m) {
  Model saved;
  saved.laws = m.laws;
  std::vector<TermOfState> terms = readModel(bytes, path, saved);
  return {std::move(saved.particles.id), std::move(terms)};
}

void loadState(const std::vector<char>& bytes, const std::string& path, Model& m) {
  Model restored = m;
  const std::vector<TermOfState> saved = readModel(bytes, path, restored);
  const bool anew = m.terms.empty();
  if (anew)
    restored.terms = makeTerms(saved, path);
  else
    requireSameTerms(saved, m.terms, path);
  loadTerms(saved, restored.terms, path);
  for (const auto& term : restored.terms) term->check(restored);
  Terms own = std::move(m.terms);  // the caller may hold references to them
  m = std::move(restored);
  m.forcesOfTerms = anew ? m.terms.revision() : own.revision();
  m.forcesOfLaws = m.laws;
  if (anew) return;
  m.terms = std::move(own);
  loadTerms(saved, m.terms, path);
}

}  // namespace dovetail::dem
