#include "solid_base.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "elements/bricks/brick_cache.hpp"
#include "elements/kernels/kernels.hpp"

namespace dovetail::fem::detail {

namespace {

constexpr std::size_t batchChunk = 16, cheapChunk = 128;  // of kernels and tet4
constexpr std::size_t nodeChunk = 1024;
constexpr std::size_t parallelNodes = 4096;  // below this many nodes of batches threads cost more than they bring

double sumOfLanes(const Lane& lane) { return (lane[0] + lane[1]) + (lane[2] + lane[3]); }

}  // namespace

SolidBase::SolidBase(SolidCells cells, std::unique_ptr<SolidPoints> points, const SolidOptions& options, bool lazy)
    : cells_(std::move(cells)),
      points_(std::move(points)),
      options_(options),
      rule_(cells_.shape == ElementShape::quad8 && options.formulation == Formulation::reduced
                ? &reducedRule(cells_.shape)
                : &forceRule(cells_.shape)) {
  options_.fraction.clear();  // the cells have it
  if (!lazy) needGeometry();
}

SolidBase::~SolidBase() = default;

void SolidBase::useKernels(const Material& law, bool assumedStress) {
  bricks_ = std::make_unique<const BrickCache>(makeBrickCache(cells_, law, assumedStress));
}

void SolidBase::needGeometry() {
  if (geometry_.empty()) geometry_ = geometryAt(cells_, *rule_);
}

void SolidBase::requireSameNodes(const Nodes& nodes) const {
  if (nodes.u.size() != cells_.X.size())
    throw InputError("there are " + std::to_string(nodes.u.size()) + " nodes for elements of a mesh with " +
                         std::to_string(cells_.X.size()),
                     options_.name, "use the nodes of the same mesh");
}

/// Calls visit(element, point, X, volume) for all quadrature points, element by element.
template <class Visit>
void SolidBase::eachPoint(Visit&& visit) const {
  const std::size_t n = cells_.nodes, points = pointCount();
  const CellRule& rule = points == static_cast<std::size_t>(rule_->points) ? *rule_ : centreRule(cells_.shape);
  for (std::size_t e = 0; e < cells_.size(); ++e)
    for (std::size_t q = 0; q < points; ++q) {
      Vec3 X;
      for (std::size_t a = 0; a < n; ++a)
        X += rule.value[n * q + a] * cells_.X[static_cast<std::size_t>(cells_.nodeOf(e, a))];
      visit(e, q, X, geometry_[e / laneCount * points + q].weight[static_cast<int>(e % laneCount)]);
    }
}

void SolidBase::openPoints() {
  if (points_->isOpen()) return;
  std::vector<PointPlace> places;
  if (points_->remembers()) {
    needGeometry();
    eachPoint([&](std::size_t e, std::size_t q, const Vec3& X, double volume) {
      places.push_back({cells_.number[e], static_cast<int>(q), X, volume});
    });
  }
  points_->open(pointCount(), places);
}

/// Has a field of points answer for all of them, unless it has.
void SolidBase::ask(const Nodes& nodes, const Instant& now, const Wanted& wanted) {
  openPoints();
  FieldPoints* const field = points_->field();
  if (field == nullptr || field->answers.knows(nodes.u, now, wanted)) return;
  needGeometry();
  parallelFor(cells_.batches(), batchChunk, [&](std::size_t begin, std::size_t end) {
    LaneVector F(9 * pointCount());
    for (std::size_t b = begin; b < end; ++b) {
      deformation(taskOf(b, nodes, now), F.data());
      field->gather(b, F.data());
    }
  });
  field->answers.ask(nodes.u, now, wanted, options_.name);
}

void SolidBase::load(ByteReader& archive) {
  openPoints();
  points_->load(archive, options_.name);
  evaluation_ = {};
}

void SolidBase::evaluate(const BatchTask& task, const Lane* F, Lane* P, Lane* tangent, Lane* energy, Lane* dissipated) {
  points_->evaluate({task.batch, task.dt, task.rateAtEnd, F, P, tangent, energy, dissipated});
}

BatchTask SolidBase::taskOf(std::size_t batch, const Nodes& nodes, const Instant& now, const Vec3* start) const {
  return {batch, nodes.u.data(), start, now.dt, false, false, now.rateAtEnd};
}

/// Place of component i of local node a among the forces of a batch, in lanes.
std::size_t SolidBase::slot(std::size_t a, std::size_t i) const { return bricks_ ? 8 * i + brickNode[a] : 3 * a + i; }

/// Calls sink(node, force) for the entries of a batch, element by element.
/// @param across  lanes between the components of a node
template <std::size_t across, class Slot, class Sink>
void SolidBase::handOut(std::size_t batch, const Lane* forces, Slot&& slotOf, Sink&& sink) const {
  const auto* const nodes = &cells_.batchNode[batch * cells_.nodes];
  for (std::size_t lane = 0; lane < cells_.inUse(batch); ++lane)
    for (std::size_t a = 0; a < cells_.nodes; ++a) {
      const auto* const own = reinterpret_cast<const double*>(forces + slotOf(a)) + lane;
      sink(static_cast<std::size_t>(nodes[a][lane]),
           Vec3{own[0], own[across * laneCount], own[2 * across * laneCount]});
    }
}

template <class Sink>
void SolidBase::handOut(std::size_t batch, const Lane* forces, Sink&& sink) const {
  if (bricks_)
    handOut<8>(
        batch, forces, [](std::size_t a) { return brickNode[a]; }, sink);
  else
    handOut<1>(
        batch, forces, [](std::size_t a) { return 3 * a; }, sink);
}

std::size_t SolidBase::chunkSize() const { return bricks_ || cells_.nodes == 4 ? cheapChunk : batchChunk; }

/// Subtracts the forces that body(batch, lanes) writes for every batch from f: for each node in the order of the
/// elements, on any number of threads.
template <class Body>
SolidBase::Totals SolidBase::eachBatch(std::span<Vec3> f, Body&& body) {
  const std::size_t count = cells_.batches();
  const auto part = [&](std::size_t begin, std::size_t end, auto&& sink) {
    Totals sum;
    Lanes<3 * maxCellNodes> forces;
    for (std::size_t b = begin; b < end; ++b) {
      sum += body(b, forces.data());
      handOut(b, forces.data(), sink);
    }
    return sum;
  };
  if (threads() == 1 || count * cells_.nodes <= parallelNodes) {
    Totals sum;
    for (std::size_t begin = 0; begin < count; begin += chunkSize())
      sum += part(begin, std::min(count, begin + chunkSize()), [&](std::size_t n, const Vec3& own) { f[n] -= own; });
    return sum;
  }
  shareNodes();
  const Totals sum = parallelSum(count, chunkSize(), [&](std::size_t begin, std::size_t end) {
    const auto chunk = static_cast<std::int32_t>(begin / chunkSize());
    std::size_t next = shared_.first[static_cast<std::size_t>(chunk)];
    return part(begin, end, [&](std::size_t n, const Vec3& own) {
      if (shared_.owner[n] == chunk)
        f[n] -= own;
      else
        shared_.late[next++] = own;
    });
  });
  parallelFor(shared_.node.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (std::uint32_t entry = shared_.offsets[k]; entry < shared_.offsets[k + 1]; ++entry)
        f[static_cast<std::size_t>(shared_.node[k])] -= shared_.late[shared_.place[entry]];
  });
  return sum;
}

SolidBase::Totals SolidBase::addAll(const Nodes& nodes, const Instant& now, const Vec3* start, std::span<Vec3> f,
                                    bool withEnergy) {
  requireSameNodes(nodes);
  const bool energyLater = !withEnergy && now.willCommit && points_->field() != nullptr;
  ask(nodes, now, {.energy = !energyLater});
  if (bricks_ && start == nullptr) {
    // The kernels are in a file of their own and write to memory, so that no compiler fuses a product of theirs with
    // the sum over elements: one thread and many then add the very same numbers.
    return eachBatch(f, [&](std::size_t b, Lane* lanes) {
      auto& forces = *reinterpret_cast<BatchForces*>(lanes);
      batchForces(*bricks_, bricks_->batches[b], nodes.u.data(), withEnergy, forces);
      return Totals{withEnergy ? sumOfLanes(forces.energy) : 0.0, 0.0};
    });
  }
  if (start != nullptr) needGeometry();
  const bool remembers = points_->remembers() && start == nullptr;
  const Totals sum = eachBatch(f, [&](std::size_t b, Lane* lanes) {
    BatchTask task = taskOf(b, nodes, now, start);
    task.wantEnergy = withEnergy || remembers;
    task.wantDissipation = remembers;
    BatchResult result;
    start == nullptr || conserves() ? forces(task, result) : balancedForces(task, result);
    for (std::size_t a = 0; a < cells_.nodes; ++a)
      for (std::size_t i = 0; i < 3; ++i) lanes[slot(a, i)] = result.f[3 * a + i];
    return Totals{task.wantEnergy ? sumOfLanes(result.energy) : 0.0,
                  task.wantDissipation ? sumOfLanes(result.dissipated) : 0.0};
  });
  if (remembers) evaluation_ = {nodes.u, now.dt, now.rateAtEnd, sum, true, !energyLater, false};
  return sum;
}

void SolidBase::addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) {
  addAll(nodes, now, nullptr, f, false);
}

double SolidBase::addForcesAndEnergy(const Nodes& nodes, const Instant& now, std::span<Vec3> f) {
  return addAll(nodes, now, nullptr, f, true).energy;
}

bool SolidBase::addConservingForces(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                                    std::span<Vec3> f) {
  if (!points_->isElastic()) return false;
  requireSameNodes(nodes);
  if (!conserves()) setPath(u0, nodes.u);
  addAll(nodes, now, u0.data(), f, false);
  return true;
}

bool SolidBase::isKnown(const Nodes& nodes, const Instant& now) const {
  return evaluation_.known && evaluation_.dt == now.dt && evaluation_.rateAtEnd == now.rateAtEnd &&
         evaluation_.u == nodes.u;
}

/// Energy and dissipation at a state, asked of the material only if the last forces were not those of the same state.
SolidBase::Totals SolidBase::totals(const Nodes& nodes, const Instant& now, bool withEnergy) {
  requireSameNodes(nodes);
  const bool known = isKnown(nodes, now);
  if (known && (evaluation_.hasEnergy || !withEnergy)) return evaluation_.totals;
  ask(nodes, now, {.toRead = true});
  const bool remembers = points_->remembers();
  const Totals sum = parallelSum(cells_.batches(), chunkSize(), [&](std::size_t begin, std::size_t end) {
    Totals part;
    BatchResult result;
    for (std::size_t b = begin; b < end; ++b) {
      BatchTask task = taskOf(b, nodes, now);
      task.wantEnergy = true;
      task.wantDissipation = remembers;
      energies(task, result);
      part += {sumOfLanes(result.energy), remembers ? sumOfLanes(result.dissipated) : 0.0};
    }
    return part;
  });
  if (remembers) evaluation_ = {nodes.u, now.dt, now.rateAtEnd, sum, true, true, known && evaluation_.committed};
  return sum;
}

/// Energy and dissipation of a batch.
void SolidBase::energies(const BatchTask& task, BatchResult& result) {
  bricks_ ? forcesByKernels(task, result) : forces(task, result);
}

void SolidBase::forcesByKernels(const BatchTask& task, BatchResult& result) const {
  BatchForces own;
  batchForces(*bricks_, bricks_->batches[task.batch], task.u, task.wantEnergy, own);
  for (std::size_t corner = 0; corner < 8; ++corner)
    for (std::size_t i = 0; i < 3; ++i) result.f[3 * brickNode[corner] + i] = own.f[i][corner];
  result.energy = task.wantEnergy ? own.energy : Lane{};
  result.dissipated = Lane{};
}

double SolidBase::energy(const Nodes& nodes, const Instant& now) { return totals(nodes, now, true).energy; }

std::vector<double> SolidBase::elementEnergies(const Nodes& nodes, const Instant& now) {
  requireSameNodes(nodes);
  ask(nodes, now, {.toRead = true});
  std::vector<double> energies(cells_.size());
  parallelFor(cells_.batches(), batchChunk, [&](std::size_t begin, std::size_t end) {
    BatchResult result;
    for (std::size_t b = begin; b < end; ++b) {
      BatchTask task = taskOf(b, nodes, now);
      task.wantEnergy = true;
      this->energies(task, result);
      for (std::size_t lane = 0; lane < cells_.inUse(b); ++lane)
        energies[laneCount * b + lane] = result.energy[static_cast<int>(lane)];
    }
  });
  evaluation_.known = false;  // what would be committed is not that of a whole evaluation any more
  return energies;
}

double SolidBase::commit(const Nodes& nodes, const Instant& now) {
  if (!points_->remembers()) return 0.0;
  if (evaluation_.committed) evaluation_.known = false;
  ask(nodes, now, {.energy = false});
  const double dissipated = totals(nodes, now, false).dissipated;
  points_->commit();
  evaluation_.committed = true;
  return dissipated;
}

/// @throws NumericalError for the first element of the batch with det F ≤ 0, or NaN
void SolidBase::requireUpright(std::size_t b, const Nodes& nodes, const std::string& when) const {
  BatchDeterminants determinants;
  batchDeterminants(*bricks_, bricks_->batches[b], nodes.u.data(), determinants);
  for (std::size_t lane = 0; lane < cells_.inUse(b); ++lane)
    for (const Lane& value : determinants.value)
      if (!(value[static_cast<int>(lane)] > 0.0))
        complain(b, lane, "is inverted (det F = " + formatNumber(value[static_cast<int>(lane)]) + ")", when);
}

void SolidBase::complain(std::size_t batch, std::size_t lane, const std::string& reason,
                         const std::string& when) const {
  throw NumericalError(
      "element " + std::to_string(cells_.number[laneCount * batch + lane]) + " of \"" + options_.name + "\" " + reason,
      when, "take a smaller step, a finer mesh or a smaller load");
}

void SolidBase::requireValid(const Nodes& nodes, const std::string& when, Scrutiny scrutiny) {
  requireSameNodes(nodes);
  const bool byKernels = bricks_ && scrutiny == Scrutiny::inversion;
  if (!byKernels) needGeometry();
  parallelFor(cells_.batches(), batchChunk, [&](std::size_t begin, std::size_t end) {
    LaneVector F(9 * pointCount());
    for (std::size_t b = begin; b < end; ++b) {
      if (byKernels) {
        requireUpright(b, nodes, when);
        continue;
      }
      compatibleDeformation({b, nodes.u.data(), nullptr, 0.0, false, false}, F.data());
      for (std::size_t lane = 0; lane < cells_.inUse(b); ++lane)
        for (std::size_t q = 0; q < pointCount(); ++q) {
          std::array<double, 9> here;
          for (std::size_t k = 0; k < 9; ++k) here[k] = F[9 * q + k][static_cast<int>(lane)];
          const std::string reason = points_->whyInvalid(here.data(), scrutiny);
          if (!reason.empty()) complain(b, lane, "at point " + std::to_string(q) + ": " + reason, when);
        }
    }
  });
}

std::size_t SolidBase::memory() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(cells_.number) + bytes(cells_.X) + bytes(cells_.fraction) + bytes(cells_.batchNode) + bytes(geometry_) +
         points_->memory() + bytes(evaluation_.u) + bytes(path_[0]) + bytes(path_[1]) + bytes(path_[2]) +
         shared_.memory() + sizeof(std::uint32_t) * cells_.batches() + bytes(places_) +
         (bricks_ ? bricks_->memory() : 0) + formulationMemory();
}

Solid::Sample SolidBase::sample(const Nodes& nodes, const Instant& now) {
  requireSameNodes(nodes);
  needGeometry();
  ask(nodes, now, {.toRead = true});
  evaluation_.known = false;
  const std::size_t points = pointCount();
  LaneVector F(9 * points), P(9 * points), energy(points);
  Sample sample;
  eachPoint([&](std::size_t e, std::size_t q, const Vec3& X, double volume) {
    if (e % laneCount == 0 && q == 0) {
      const BatchTask task = taskOf(e / laneCount, nodes, now);
      deformation(task, F.data());
      evaluate(task, F.data(), P.data(), nullptr, energy.data(), nullptr);
    }
    const int lane = static_cast<int>(e % laneCount);
    sample.element.push_back(cells_.number[e]);
    sample.X.push_back(X);
    sample.volume.push_back(volume);
    for (std::size_t k = 0; k < 9; ++k) {
      sample.F.push_back(F[9 * q + k][lane]);
      sample.P.push_back(P[9 * q + k][lane]);
    }
    sample.energy.push_back(energy[q][lane]);
    const std::span<const double> history = points_->history(e, q);
    sample.history.insert(sample.history.end(), history.begin(), history.end());
  });
  return sample;
}

}  // namespace dovetail::fem::detail
