#include "run_state.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "force_sum.hpp"

namespace dovetail::fem::detail {

namespace {

constexpr const char* remedy = "load it into the run that saved it";

/// Of as many nodes as the model has, unless these come with the state.
std::vector<Vec3> readField(ByteReader& archive, const Model& model, const std::string& what) {
  std::vector<Vec3> field;
  archive(field);
  if (const std::size_t nodes = model.nodes.u.size(); field.size() != nodes && !ownsNodes(model))
    throw InputError("the state has " + std::to_string(field.size()) + " nodes, the model " + std::to_string(nodes),
                     what, remedy);
  const auto bad = std::ranges::find_if_not(field, [](const Vec3& value) { return isFinite(value); });
  if (bad != field.end())
    throw InputError("the " + what + " of node " + std::to_string(bad - field.begin()) + " is not finite", "state",
                     remedy);
  return field;
}

std::vector<char> stateOf(const Term& term) {
  ByteWriter archive;
  term.save(archive);
  return archive.bytes();
}

void requireSameTerms(ByteReader& archive, const Model& model) {
  const std::int64_t count = readCount(archive, "number of terms");
  if (count != static_cast<std::int64_t>(model.terms.size()))
    throw InputError(
        "the state has " + std::to_string(count) + " terms, the model " + std::to_string(model.terms.size()), "state",
        remedy);
  for (const auto& term : model.terms)
    if (const std::string name = readText(archive); name != term->name())
      throw InputError("the state has \"" + name + "\" where the model has \"" + term->name() + "\"", "terms", remedy);
}

}  // namespace

std::string readText(ByteReader& archive) {
  std::string text;
  archive(text);
  return text;
}

double readNumber(ByteReader& archive, const std::string& what) {
  double value = 0.0;
  archive(value);
  if (!std::isfinite(value)) throw InputError("the " + what + " is not finite", "state", remedy);
  return value;
}

std::int64_t readCount(ByteReader& archive, const std::string& what) {
  constexpr std::int64_t most = std::int64_t{1} << 53;
  std::int64_t value = 0;
  archive(value);
  if (value < 0 || value > most) throw InputError("the " + what + " is " + std::to_string(value), "state", remedy);
  return value;
}

void requireEnd(const ByteReader& archive, const std::string& where) {
  if (!archive.atEnd()) throw InputError("the state has extra data", where, remedy);
}

void writeModel(ByteWriter& archive, const std::string& run, const Model& model) {
  archive(run, static_cast<std::int64_t>(model.terms.size()));
  for (const auto& term : model.terms) archive(term->name());
  archive(model.t, model.nodes.u, model.nodes.v);
  for (const auto& term : model.terms) archive(stateOf(*term));
}

ModelState readModel(ByteReader& archive, const std::string& run, const Model& model) {
  if (const std::string kind = readText(archive); kind != run)
    throw InputError("the state is not that of an " + run + " run", "load", remedy);
  requireSameTerms(archive, model);
  ModelState state{readNumber(archive, "time"), readField(archive, model, "displacement"),
                   readField(archive, model, "velocity"), std::vector<std::vector<char>>(model.terms.size())};
  for (std::vector<char>& bytes : state.terms) archive(bytes);
  return state;
}

void adopt(ModelState state, Model& model) {
  const Nodes nodesBefore = model.nodes;
  std::vector<std::vector<char>> before;
  for (const auto& term : model.terms) before.push_back(stateOf(*term));
  const auto loadTerms = [&](const std::vector<std::vector<char>>& bytes) {
    for (std::size_t k = 0; k < bytes.size(); ++k) {
      ByteReader archive(bytes[k]);
      model.terms[k]->load(archive);
      requireEnd(archive, model.terms[k]->name());
      model.terms[k]->layNodes(model.nodes);
    }
  };
  try {
    loadTerms(state.terms);
    if (state.u.size() != model.nodes.X.size() || state.v.size() != model.nodes.X.size())
      throw InputError("the state has displacements of " + std::to_string(state.u.size()) + " nodes and lays out " +
                           std::to_string(model.nodes.X.size()),
                       "state", remedy);
  } catch (...) {
    loadTerms(before);
    model.nodes = nodesBefore;
    throw;
  }
  model.t = state.t;
  model.nodes.u = std::move(state.u);
  model.nodes.v = std::move(state.v);
}

void writeStart(ByteWriter& archive, const StepStart& start) {
  archive(start.a, start.f);
  for (const std::vector<Vec3>& load : start.loads)
    if (!load.empty()) archive(load);
}

StepStart readStart(ByteReader& archive, const Model& model) {
  StepStart start{readField(archive, model, "acceleration"), readField(archive, model, "force"), {}};
  for (const auto& term : model.terms)
    start.loads.push_back(isKeptApart(*term) ? readField(archive, model, "load") : std::vector<Vec3>());
  return start;
}

}  // namespace dovetail::fem::detail
