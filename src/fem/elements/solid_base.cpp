#include "solid_base.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::fem::detail {

namespace {

constexpr std::size_t batchGrain = 16;
constexpr std::size_t nodeGrain = 1024;
constexpr std::size_t parallelNodes = 4096;  // below this many nodes of batches threads cost more than they bring

double sumOfLanes(const Lane& lane) { return (lane[0] + lane[1]) + (lane[2] + lane[3]); }

}  // namespace

SolidBase::SolidBase(SolidCells cells, std::shared_ptr<const PointMaterial> material, const SolidOptions& options)
    : cells_(std::move(cells)),
      material_(std::move(material)),
      options_(options),
      rule_(&forceRule(cells_.shape)),
      geometry_(geometryAt(cells_, *rule_)) {
  listEntries();
  colourBatches();
}

void SolidBase::requireSameNodes(const Nodes& nodes) const {
  if (nodes.u.size() != cells_.X.size())
    throw InputError("there are " + std::to_string(nodes.u.size()) + " nodes for elements of a mesh with " +
                         std::to_string(cells_.X.size()),
                     options_.name, "use the nodes of the same mesh");
}

/// Fills the history on first use, when the number of points is known.
void SolidBase::startHistory() {
  const std::size_t size = material_->historySize(), lanes = cells_.batches() * points() * laneCount;
  if (size == 0 || !history_.empty()) return;
  history_.resize(lanes * size);
  for (std::size_t p = 0; p < lanes; ++p) material_->startHistory(std::span(history_).subspan(p * size, size));
  newHistory_ = history_;
}

void SolidBase::load(ByteReader& archive) {
  startHistory();
  history_ = readNumbers(archive, history_.size());
}

std::vector<double> SolidBase::readNumbers(ByteReader& archive, std::size_t count) const {
  std::vector<double> values;
  archive(values);
  if (values.size() != count)
    throw InputError("the state is that of another solid", options_.name, "load it into the model that wrote it");
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    throw InputError("the state is not finite", options_.name, "take an older one");
  return values;
}

void SolidBase::evaluate(const BatchTask& task, const Lane* F, Lane* P, Lane* tangent, Lane* energy, Lane* dissipated) {
  const std::size_t size = material_->historySize(), offset = task.batch * points() * laneCount * size;
  PointBatch batch{};
  batch.groups = points();
  batch.F = reinterpret_cast<const double*>(F);
  batch.P = reinterpret_cast<double*>(P);
  batch.tangent = reinterpret_cast<double*>(tangent);
  batch.energy = reinterpret_cast<double*>(energy);
  batch.dissipated = reinterpret_cast<double*>(dissipated);
  if (size > 0) {
    batch.history = history_.data() + offset;
    batch.newHistory = newHistory_.data() + offset;
  }
  batch.dt = task.dt;
  material_->evaluate(batch);
}

BatchTask SolidBase::taskOf(std::size_t batch, const Nodes& nodes, const Instant& now, const Vec3* start) const {
  return {batch, nodes.u.data(), start, now.dt, false, false};
}

void SolidBase::addAll(const Nodes& nodes, const Instant& now, const Vec3* start, std::span<Vec3> f) {
  requireSameNodes(nodes);
  startHistory();
  const std::size_t count = cells_.batches(), perBatch = cells_.nodes;
  const auto body = [&](std::size_t b, BatchResult& result) {
    const BatchTask task = taskOf(b, nodes, now, start);
    start == nullptr || conserves() ? forces(task, result) : balancedForces(task, result);
  };
  if (threads() == 1 || count * perBatch < parallelNodes) {
    BatchResult result;
    for (std::size_t b = 0; b < count; ++b) {
      body(b, result);
      for (std::size_t lane = 0; lane < cells_.inUse(b); ++lane)
        for (std::size_t a = 0; a < perBatch; ++a) {
          Vec3& node = f[static_cast<std::size_t>(cells_.batchNode[b * perBatch + a][lane])];
          for (int i = 0; i < 3; ++i) node[i] -= result.f[3 * a + static_cast<std::size_t>(i)][lane];
        }
    }
    return;
  }
  const std::size_t size = 3 * perBatch;
  results_.resize(count * size);
  parallelFor(count, batchGrain, [&](std::size_t begin, std::size_t end) {
    BatchResult result;
    for (std::size_t b = begin; b < end; ++b) {
      body(b, result);
      std::copy_n(result.f.begin(), size, results_.begin() + static_cast<std::ptrdiff_t>(b * size));
    }
  });
  const auto* const values = reinterpret_cast<const double*>(results_.data());
  parallelFor(f.size(), nodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (std::uint32_t k = nodeOffsets_[n]; k < nodeOffsets_[n + 1]; ++k) {
        const double* const value = values + nodeEntries_[k];
        f[n].x -= value[0];
        f[n].y -= value[laneCount];
        f[n].z -= value[2 * laneCount];
      }
  });
}

void SolidBase::addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) { addAll(nodes, now, nullptr, f); }

bool SolidBase::addConservingForces(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                                    std::span<Vec3> f) {
  if (!material_->isElastic()) return false;
  requireSameNodes(nodes);
  if (!conserves()) setPath(u0, nodes.u);
  addAll(nodes, now, u0.data(), f);
  return true;
}

std::array<double, 2> SolidBase::totals(const Nodes& nodes, const Instant& now, bool wantEnergy, bool wantDissipation) {
  requireSameNodes(nodes);
  startHistory();
  struct Sum {
    double energy = 0.0, dissipated = 0.0;
    Sum& operator+=(const Sum& other) {
      energy += other.energy;
      dissipated += other.dissipated;
      return *this;
    }
  };
  const Sum sum = parallelSum(cells_.batches(), batchGrain, [&](std::size_t begin, std::size_t end) {
    Sum part;
    BatchResult result;
    for (std::size_t b = begin; b < end; ++b) {
      BatchTask task = taskOf(b, nodes, now);
      task.wantEnergy = wantEnergy;
      task.wantDissipation = wantDissipation;
      forces(task, result);
      if (wantEnergy) part.energy += sumOfLanes(result.energy);
      if (wantDissipation) part.dissipated += sumOfLanes(result.dissipated);
    }
    return part;
  });
  return {sum.energy, sum.dissipated};
}

double SolidBase::energy(const Nodes& nodes, const Instant& now) { return totals(nodes, now, true, false)[0]; }

double SolidBase::commit(const Nodes& nodes, const Instant& now) {
  if (material_->historySize() == 0) return 0.0;
  const double dissipated = totals(nodes, now, false, true)[1];
  history_.swap(newHistory_);
  return dissipated;
}

void SolidBase::requireValid(const Nodes& nodes, const std::string& when) const {
  requireSameNodes(nodes);
  LaneVector F(9 * points());
  for (std::size_t b = 0; b < cells_.batches(); ++b) {
    compatibleDeformation({b, nodes.u.data(), nullptr, 0.0, false, false}, F.data());
    for (std::size_t q = 0; q < points(); ++q)
      for (std::size_t lane = 0; lane < cells_.inUse(b); ++lane) {
        std::array<double, 9> here;
        for (std::size_t k = 0; k < 9; ++k) here[k] = F[9 * q + k][lane];
        const std::string reason = material_->whyInvalid(here.data());
        if (reason.empty()) continue;
        throw NumericalError("element " + std::to_string(cells_.number[laneCount * b + lane]) + " of \"" +
                                 options_.name + "\": " + reason,
                             when, "take a smaller step, a finer mesh or a smaller load");
      }
  }
}

std::size_t SolidBase::memory() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(cells_.node) + bytes(cells_.X) + bytes(cells_.batchNode) + bytes(geometry_) + bytes(history_) +
         bytes(newHistory_) + bytes(results_) + bytes(nodeOffsets_) + bytes(nodeEntries_) + bytes(places_);
}

Solid::Sample SolidBase::sample(const Nodes& nodes, const Instant& now) {
  requireSameNodes(nodes);
  startHistory();
  const std::size_t n = cells_.nodes, q = points(), size = material_->historySize();
  LaneVector F(9 * q), P(9 * q), energy(q);
  Sample sample;
  for (std::size_t b = 0; b < cells_.batches(); ++b) {
    const BatchTask task = taskOf(b, nodes, now);
    deformation(task, F.data());
    evaluate(task, F.data(), P.data(), nullptr, energy.data(), nullptr);
    const CellRule& rule = q == static_cast<std::size_t>(rule_->points) ? *rule_ : centreRule(cells_.shape);
    for (std::size_t lane = 0; lane < cells_.inUse(b); ++lane)
      for (std::size_t p = 0; p < q; ++p) {
        sample.element.push_back(cells_.number[laneCount * b + lane]);
        Vec3 X;
        for (std::size_t a = 0; a < n; ++a)
          X += rule.value[n * p + a] * cells_.X[static_cast<std::size_t>(cells_.batchNode[n * b + a][lane])];
        sample.X.push_back(X);
        sample.volume.push_back(geometry_[b * q + p].weight[lane]);
        for (std::size_t k = 0; k < 9; ++k) {
          sample.F.push_back(F[9 * p + k][lane]);
          sample.P.push_back(P[9 * p + k][lane]);
        }
        sample.energy.push_back(energy[p][lane]);
        const std::size_t point = (b * q + p) * laneCount + lane;
        sample.history.insert(sample.history.end(), history_.begin() + static_cast<std::ptrdiff_t>(point * size),
                              history_.begin() + static_cast<std::ptrdiff_t>((point + 1) * size));
      }
  }
  return sample;
}

}  // namespace dovetail::fem::detail
