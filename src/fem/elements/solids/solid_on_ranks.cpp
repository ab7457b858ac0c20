#include "solid_on_ranks.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/linalg/partition.hpp"
#include "solid_base.hpp"
#include "solid_points.hpp"

namespace dovetail::fem::detail {

namespace {

/// Of a state of so many elements.
std::size_t numbersOf(const StateShape& shape, std::size_t elements) {
  return (elements + laneCount - 1) / laneCount * laneCount * shape.groups * shape.record;
}
/// Where element e has its numbers of a group.
std::size_t placeOf(const StateShape& shape, std::size_t e, std::size_t group) {
  return ((e / laneCount * shape.groups + group) * laneCount + e % laneCount) * shape.record;
}
std::vector<double> byElements(std::span<const double> batches, const StateShape& shape, std::size_t elements) {
  std::vector<double> values;
  for (std::size_t e = 0; e < elements; ++e)
    for (std::size_t g = 0; g < shape.groups; ++g) {
      const std::span<const double> record = batches.subspan(placeOf(shape, e, g), shape.record);
      values.insert(values.end(), record.begin(), record.end());
    }
  return values;
}
std::vector<double> inBatches(std::span<const double> values, const StateShape& shape, std::size_t elements) {
  std::vector<double> batches(numbersOf(shape, elements));
  const std::size_t lanes = (elements + laneCount - 1) / laneCount * laneCount;
  for (std::size_t e = 0; e < lanes; ++e)
    for (std::size_t g = 0; g < shape.groups; ++g) {
      const std::size_t from = (std::min(e, elements - 1) * shape.groups + g) * shape.record;
      std::ranges::copy(values.subspan(from, shape.record),
                        batches.begin() + static_cast<std::ptrdiff_t>(placeOf(shape, e, g)));
    }
  return batches;
}

std::span<double> numbersOf(std::span<Vec3> field) { return {field.empty() ? nullptr : &field[0].x, 3 * field.size()}; }

class SolidOnRanks final : public Solid {
public:
  SolidOnRanks(std::shared_ptr<SolidBase> share, const std::vector<std::vector<int>>& numbers)
      : share_(std::move(share)) {
    std::vector<int> all;
    for (const std::vector<int>& rank : numbers) {
      all.insert(all.end(), rank.begin(), rank.end());
      sizes_.push_back(rank.size());
    }
    order_.resize(all.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::sort(order_, {}, [&](std::size_t k) { return all[k]; });
    numbers_ = std::move(all);
    std::ranges::sort(numbers_);
  }

  std::string name() const override { return share_->name(); }
  bool isShared() const override { return true; }
  bool usesVelocity() const override { return share_->usesVelocity(); }
  bool feelsRates() const override { return share_->feelsRates(); }
  bool isSymmetric() const override { return share_->isSymmetric(); }
  bool hasEnergy() const override { return share_->hasEnergy(); }
  std::size_t size() const override { return numbers_.size(); }
  std::vector<std::size_t> sizesOnRanks() const override { return sizes_; }
  /// Of this rank.
  std::size_t memory() const override { return share_->memory(); }
  const PointMaterial* material() const override { return share_->material(); }
  const PointField* field() const override { return nullptr; }
  double density() const override { return share_->density(); }
  std::span<const double> fraction() const override { return share_->fraction(); }
  ElementShape shape() const override { return share_->shape(); }
  Formulation formulation() const override { return share_->formulation(); }
  int number(std::size_t e) const override { return numbers_[e]; }

  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override {
    addSum(f, [&](std::span<Vec3> own) { share_->addForces(nodes, now, own); });
  }
  double addForcesAndEnergy(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override {
    double energy = 0.0;
    addSum(f, [&](std::span<Vec3> own) { energy = share_->addForcesAndEnergy(nodes, now, own); });
    return team().sum(energy);
  }
  bool addConservingForces(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                           std::span<Vec3> f) override {
    bool has = false;
    addSum(f, [&](std::span<Vec3> own) { has = share_->addConservingForces(nodes, u0, now, own); });
    return has;
  }
  void addPattern(linalg::MatrixPattern& pattern) const override { share_->addPattern(pattern); }
  void addTangent(const Nodes& nodes, const Instant& now, linalg::BlockMatrix& K) override {
    together([&] { share_->addTangent(nodes, now, K); });
  }
  void addConservingTangent(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                            linalg::BlockMatrix& K) override {
    together([&] { share_->addConservingTangent(nodes, u0, now, K); });
  }
  double energy(const Nodes& nodes, const Instant& now) override {
    return sumOf([&] { return share_->energy(nodes, now); });
  }
  double hourglassEnergy(const Nodes& nodes) override {
    return sumOf([&] { return share_->hourglassEnergy(nodes); });
  }
  double commit(const Nodes& nodes, const Instant& now) override {
    return sumOf([&] { return share_->commit(nodes, now); });
  }
  void revert() override { share_->revert(); }
  void requireValid(const Nodes& nodes, const std::string& when, Scrutiny scrutiny) override {
    together([&] { share_->requireValid(nodes, when, scrutiny); });
  }
  std::optional<StableStep> stableStep(const Nodes& nodes) override {
    std::optional<StableStep> own, least;
    together([&] { own = share_->stableStep(nodes); });
    ByteWriter letter;
    letter(own.has_value());
    if (own) letter(own->dt, own->owner, own->element);
    for (std::vector<char>& arrived : team().gather(letter.take())) {
      ByteReader reader(std::move(arrived));
      bool has = false;
      reader(has);
      if (!has) continue;
      StableStep other;
      reader(other.dt, other.owner, other.element);
      other.solid = name();
      if (!least || other.dt < least->dt) least = other;
    }
    return least;
  }

  void addMass(std::span<double> mass) const override {
    addSum(mass, [&](std::span<double> own) { share_->addMass(own); });
  }
  void addBodyMass(std::span<double> mass) const override {
    addSum(mass, [&](std::span<double> own) { share_->addBodyMass(own); });
  }
  void addConsistentMass(linalg::NodeMatrix& M) const override { share_->addConsistentMass(M); }

  /// As one process writes it, and reads it.
  void save(ByteWriter& archive) const override {
    ByteWriter own;
    share_->save(own);
    ByteReader reader(own.take());
    for (const StateShape& shape : share_->stateShapes()) {
      std::vector<double> values;
      reader(values);
      archive(inBatches(inOrder<double>(byElements(values, shape, share_->size())), shape, size()));
    }
  }
  void load(ByteReader& archive) override {
    ByteWriter own;
    for (const StateShape& shape : share_->stateShapes()) {
      const std::size_t each = shape.groups * shape.record;
      const std::vector<double> values = readNumbers(archive, numbersOf(shape, size()), name());
      const std::vector<double> all = byElements(values, shape, size());
      std::vector<double> mine;
      for (std::size_t e = 0; e < share_->size(); ++e) {
        const auto place = std::ranges::lower_bound(numbers_, share_->number(e)) - numbers_.begin();
        const auto first = all.begin() + place * static_cast<std::ptrdiff_t>(each);
        mine.insert(mine.end(), first, first + static_cast<std::ptrdiff_t>(each));
      }
      own(inBatches(mine, shape, share_->size()));
    }
    together([&] {
      ByteReader reader(own.take());
      share_->load(reader);
    });
  }

  std::vector<double> elementEnergies(const Nodes& nodes, const Instant& now) override {
    std::vector<double> own;
    together([&] { own = share_->elementEnergies(nodes, now); });
    return inOrder<double>(own);
  }
  Sample sample(const Nodes& nodes, const Instant& now) override {
    Sample own;
    together([&] { own = share_->sample(nodes, now); });
    return {.element = inOrder<int>(own.element),
            .X = inOrder<Vec3>(own.X),
            .volume = inOrder<double>(own.volume),
            .F = inOrder<double>(own.F),
            .P = inOrder<double>(own.P),
            .energy = inOrder<double>(own.energy),
            .history = inOrder<double>(own.history)};
  }

private:
  template <class Act>
  double sumOf(Act&& act) {
    double own = 0.0;
    together([&] { own = act(); });
    return team().sum(own);
  }
  template <class T, class Act>
  void addSum(std::span<T> to, Act&& act) const {
    std::vector<T> own(to.size());
    together([&] { act(std::span<T>(own)); });
    if constexpr (std::is_same_v<T, Vec3>)
      team().sum(numbersOf(own));
    else
      team().sum(own);
    for (std::size_t n = 0; n < to.size(); ++n) to[n] += own[n];
  }
  /// What there are so many of for each element, from all ranks, elements ascending.
  template <class T>
  std::vector<T> inOrder(std::span<const T> own) const {
    ByteWriter letter;
    letter(std::vector<T>(own.begin(), own.end()));
    std::vector<T> all;
    for (std::vector<char>& arrived : team().gather(letter.take())) {
      ByteReader reader(std::move(arrived));
      std::vector<T> part;
      reader(part);
      all.insert(all.end(), part.begin(), part.end());
    }
    const std::size_t each = all.size() / order_.size();
    std::vector<T> sorted;
    sorted.reserve(all.size());
    for (const std::size_t from : order_)
      sorted.insert(sorted.end(), all.begin() + static_cast<std::ptrdiff_t>(from * each),
                    all.begin() + static_cast<std::ptrdiff_t>((from + 1) * each));
    return sorted;
  }

  std::shared_ptr<SolidBase> share_;
  std::vector<std::size_t> sizes_;  // of each rank
  std::vector<int> numbers_;        // of all ranks, ascending
  std::vector<std::size_t> order_;  // of those, rank after rank
};

}  // namespace

std::optional<std::vector<std::vector<int>>> keepShare(SolidCells& cells) {
  const auto ranks = static_cast<std::size_t>(team().size());
  const int each = cornersOf(cells.shape);
  std::vector<int> corners;
  corners.reserve(cells.size() * static_cast<std::size_t>(each));
  for (std::size_t e = 0; e < cells.size(); ++e)
    for (int a = 0; a < each; ++a) corners.push_back(cells.nodeOf(e, static_cast<std::size_t>(a)));
  std::vector<int> owner = linalg::partitionCells(dimensionOf(cells.shape), cells.X.size(), each, corners);
  std::vector<std::vector<int>> numbers(ranks);
  std::vector<int> own;
  for (std::size_t e = 0; e < owner.size(); ++e) {
    numbers[static_cast<std::size_t>(owner[e])].push_back(cells.number[e]);
    if (owner[e] == team().rank()) own.push_back(static_cast<int>(e));
  }
  if (std::ranges::any_of(numbers, [](const auto& rank) { return rank.empty(); })) return std::nullopt;
  keep(cells, own);
  return numbers;
}

std::shared_ptr<Solid> solidOnRanks(const std::shared_ptr<Solid>& share, const std::vector<std::vector<int>>& numbers) {
  return std::make_shared<SolidOnRanks>(std::dynamic_pointer_cast<SolidBase>(share), numbers);
}

}  // namespace dovetail::fem::detail
