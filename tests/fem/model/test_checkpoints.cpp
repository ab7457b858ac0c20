#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dynamics_helpers.hpp"

namespace dovetail::fem {
namespace {

using Bytes = std::vector<char>;

/// A brick with everything that remembers: plastic strain, enhanced modes, friction; and loads with and without energy.
Model rememberingBrick(bool loaded = true) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 1}, {}, {0.1, 0.1, 0.1});
  Model model = makeModel(mesh);
  const J2Plasticity metal{1e7, 0.3, 1000.0, linearYield(2e4, 1e5)};
  model.add(makeSolid(mesh, pointMaterial(metal), {.formulation = Formulation::enhanced}));
  addMass(model);
  ContactOptions contact;
  contact.penalty = 1e8;
  contact.friction = 0.3;
  model.add(makeContactPlane(mesh, faceSet(mesh, "z-"), {{}, {0, 0, 1}, {}}, contact));
  model.add(massDamping(3.0));
  if (loaded) model.add(gravity(Vec3{0, 0, -9.81}));
  for (Vec3& v : model.nodes.v) v = {1.0, 0, -20.0};
  return model;
}

/// A model and its integrator after some steps.
template <class Integrator>
struct Run {
  Model model;
  Integrator integrator;
  explicit Run(Model&& start, int steps) : model(std::move(start)), integrator(model, 1e-5) { integrator.run(steps); }
  Bytes save() {
    ByteWriter archive;
    integrator.save(archive);
    return archive.bytes();
  }
};

struct Snapshot {
  double t;
  std::vector<Vec3> u, v;
  std::vector<Bytes> terms;
  explicit Snapshot(const Model& model) : t(model.t), u(model.nodes.u), v(model.nodes.v) {
    for (const auto& term : model.terms) {
      ByteWriter archive;
      term->save(archive);
      terms.push_back(archive.bytes());
    }
  }
  bool operator==(const Snapshot&) const = default;
};

/// Whether the state was taken; if not, by an InputError that left the model as it was.
template <class Integrator>
bool takes(Run<Integrator>& run, const Bytes& state) {
  const Snapshot before(run.model);
  const std::int64_t steps = run.integrator.report().steps;
  const double residual = run.integrator.ledger().residual();
  try {
    ByteReader archive(state);
    run.integrator.load(archive);
    return true;
  } catch (const InputError&) {
    EXPECT_TRUE(Snapshot(run.model) == before);
    EXPECT_EQ(run.integrator.report().steps, steps);
    EXPECT_EQ(run.integrator.ledger().residual(), residual);
  }
  return false;
}

using ExplicitRun = Run<ExplicitIntegrator>;
using ImplicitRun = Run<ImplicitIntegrator>;

/// Factors that served before the state serve after it, in the run that saves as in the one that goes on from it.
template <class Integrator>
void expectSavingToChangeNothing() {
  Run<Integrator> whole(rememberingBrick(), 40), saving(rememberingBrick(), 0);
  for (int k = 0; k < 40; ++k) {
    saving.integrator.run(1);
    Run<Integrator> next(rememberingBrick(), 0);
    ASSERT_TRUE(takes(next, saving.save()));
    next.integrator.run(39 - k);
    ASSERT_TRUE(Snapshot(next.model) == Snapshot(whole.model)) << "after " << k + 1 << " steps";
  }
  EXPECT_TRUE(Snapshot(saving.model) == Snapshot(whole.model));
}

TEST(Checkpoints, ChangeNothingThatFollows) {
  expectSavingToChangeNothing<ExplicitIntegrator>();
  expectSavingToChangeNothing<ImplicitIntegrator>();
}

TEST(Checkpoints, KeepFactorsThatServe) {
  ImplicitRun whole(rememberingBrick(), 40), saving(rememberingBrick(), 0);
  for (int k = 0; k < 40; ++k) {
    saving.integrator.run(1);
    saving.save();
  }
  EXPECT_LT(whole.integrator.report().factorisations, 40);
  EXPECT_EQ(saving.integrator.report().factorisations, whole.integrator.report().factorisations);
}

TEST(Checkpoints, AreForTheKindOfRunThatWroteThem) {
  ExplicitRun one(rememberingBrick(), 20);
  ImplicitRun two(rememberingBrick(), 20);
  const Bytes explicitState = one.save(), implicitState = two.save();
  one.integrator.run(3);
  two.integrator.run(3);
  EXPECT_FALSE(takes(one, implicitState));
  EXPECT_FALSE(takes(two, explicitState));
  EXPECT_TRUE(takes(one, explicitState));
  EXPECT_TRUE(takes(two, implicitState));
  Model model = rememberingBrick();
  ImplicitIntegrator conserving(model, 1e-5, {.scheme = energyMomentum()});
  ByteReader archive(implicitState);
  EXPECT_THROW(conserving.load(archive), InputError);
}

TEST(Checkpoints, AreForTheTermsThatWroteThem) {
  ExplicitRun loaded(rememberingBrick(true), 20), free(rememberingBrick(false), 20);
  EXPECT_FALSE(takes(free, loaded.save()));
  EXPECT_FALSE(takes(loaded, free.save()));
  Model renamed = rememberingBrick(false);
  renamed.add(gravity(Vec3{0, 0, -9.81}, "weight"));
  ExplicitRun other(std::move(renamed), 20);
  EXPECT_FALSE(takes(other, loaded.save()));
}

template <class Integrator>
void expectDamageToBeRefused() {
  Run<Integrator> run(rememberingBrick(), 20);
  const Bytes state = run.save();
  run.integrator.run(3);
  for (std::size_t length = 0; length < state.size(); length += 1 + length / 50)
    EXPECT_FALSE(takes(run, Bytes(state.begin(), state.begin() + static_cast<std::ptrdiff_t>(length)))) << length;
  Bytes longer = state;
  longer.push_back(0);
  EXPECT_FALSE(takes(run, longer));
  EXPECT_TRUE(takes(run, state));
}

TEST(Checkpoints, ThatAreCutOffOrTooLongAreRefused) {
  expectDamageToBeRefused<ExplicitIntegrator>();
  expectDamageToBeRefused<ImplicitIntegrator>();
}

/// Every number of the state in turn, wherever it lies.
template <class Integrator>
void expectNumbersThatAreNotFiniteToBeRefused() {
  Run<Integrator> run(rememberingBrick(), 20);
  const Bytes state = run.save();
  run.integrator.run(3);
  std::vector<double> numbers = {run.model.t};
  Run<Integrator> saved(rememberingBrick(), 20);
  for (const auto* field : {&saved.model.nodes.u, &saved.model.nodes.v})
    for (const Vec3& value : *field)
      for (int c = 0; c < 3; ++c) numbers.push_back(value[c]);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int found = 0;
  for (std::size_t k = 1; k < numbers.size(); ++k) {
    const auto place = std::search(state.begin(), state.end(), reinterpret_cast<const char*>(&numbers[k]),
                                   reinterpret_cast<const char*>(&numbers[k] + 1));
    if (place == state.end()) continue;
    ++found;
    Bytes damaged = state;
    std::memcpy(&damaged[static_cast<std::size_t>(place - state.begin())], &nan, sizeof nan);
    EXPECT_FALSE(takes(run, damaged)) << "number " << k;
  }
  EXPECT_EQ(found, static_cast<int>(numbers.size()) - 1);
}

TEST(Checkpoints, WithNumbersThatAreNotFiniteAreRefused) {
  expectNumbersThatAreNotFiniteToBeRefused<ExplicitIntegrator>();
  expectNumbersThatAreNotFiniteToBeRefused<ImplicitIntegrator>();
}

TEST(Checkpoints, KindsOfChannelsStandForSomething) {
  ImplicitRun run(rememberingBrick(), 20);
  const Bytes state = run.save();
  const EnergyLedger& ledger = run.integrator.ledger();
  int booked = 0;
  for (const EnergyLedger::Channel& channel : ledger.channels()) {
    if (channel.kind != EnergyLedger::Kind::booked) continue;
    ++booked;
    const auto name = std::search(state.begin(), state.end(), channel.name.begin(), channel.name.end());
    ASSERT_NE(name, state.end());
    Bytes damaged = state;
    const auto kind = damaged.begin() + (name - state.begin()) + static_cast<std::ptrdiff_t>(channel.name.size());
    ASSERT_EQ(*kind, 1) << channel.name;
    *kind = 2;
    EXPECT_FALSE(takes(run, damaged)) << channel.name;
  }
  EXPECT_GT(booked, 0);
}

Bytes mutated(const Bytes& state, std::mt19937& random) {
  Bytes bytes = state;
  const auto below = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
  };
  const std::size_t place = below(bytes.size() - 8);
  const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(place);
  const std::uint64_t patterns[] = {0, ~std::uint64_t{0}, 0x7ff0000000000000, std::uint64_t{1} << 60, 3, below(1000)};
  switch (below(5)) {
    case 0:
      bytes[place] = static_cast<char>(below(256));
      break;
    case 1:
      std::memcpy(&bytes[place], &patterns[below(6)], 8);
      break;
    case 2:
      std::memcpy(&bytes[8 * (place / 8)], &patterns[below(6)], 8);
      break;
    case 3:
      bytes.erase(at, at + static_cast<std::ptrdiff_t>(1 + below(8)));
      break;
    default:
      bytes.insert(at, 1 + below(8), static_cast<char>(below(256)));
  }
  return bytes;
}

template <class Integrator>
void expectMutationsToDoNoHarm() {
  Run<Integrator> run(rememberingBrick(), 20), reference(rememberingBrick(), 20);
  const Bytes state = run.save();
  std::mt19937 random(7);
  int refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Bytes bytes = mutated(state, random);
    if (takes(run, bytes))
      ASSERT_TRUE(takes(run, state)) << trial;
    else
      ++refused;
  }
  EXPECT_GT(refused, 1000);
  run.integrator.run(10);
  reference.integrator.run(10);
  EXPECT_TRUE(Snapshot(run.model) == Snapshot(reference.model));
}

TEST(Checkpoints, MutationsDoNoHarm) {
  expectMutationsToDoNoHarm<ExplicitIntegrator>();
  expectMutationsToDoNoHarm<ImplicitIntegrator>();
}

}  // namespace
}  // namespace dovetail::fem
