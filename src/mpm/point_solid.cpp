#include "dovetail/mpm/point_solid.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "scatter.hpp"
#include "transfer.hpp"

namespace dovetail::mpm {

namespace {

using fem::Instant;
using fem::Nodes;
using fem::Wanted;
constexpr std::size_t pointChunk = 512;

double norm2(const Vec3& v) { return squaredNorm(v); }
double norm2(double v) { return v * v; }

Vec3 rowTimes(const double* A, const Vec3& s) {
  return {A[0] * s.x + A[1] * s.y + A[2] * s.z, A[3] * s.x + A[4] * s.y + A[5] * s.z,
          A[6] * s.x + A[7] * s.y + A[8] * s.z};
}

class Points final : public PointSolid {
public:
  Points(const MaterialPoints& points, std::shared_ptr<fem::PointField> field, const PointOptions& options)
      : options_(options),
        answers_(std::move(field)),
        carried_{{}, points.x, points.v, {}},
        volume_(points.volume),
        F0_(9 * points.x.size(), 0.0) {
    carried_.v.resize(points.x.size());
    if (options.transfer == Transfer::apic) carried_.moment.assign(F0_.size(), 0.0);
    for (std::size_t k = 0; k < F0_.size(); ++k) F0_[k] = k % 9 % 4 == 0 ? 1.0 : 0.0;
    std::vector<fem::PointPlace> places;
    for (std::size_t p = 0; p < points.x.size(); ++p) {
      carried_.mass.push_back(answers_.field().density() * volume_[p]);
      places.push_back({-1, static_cast<int>(p), points.x[p], volume_[p]});
    }
    answers_.open(places);
  }

  std::string name() const override { return options_.name; }
  bool usesVelocity() const override { return false; }
  bool actsWithin() const override { return true; }
  bool isBody() const override { return true; }
  bool isSymmetric() const override { return answers_.field().isSymmetric(); }
  bool feelsRates() const override { return answers_.field().feelsRates(); }
  bool hasEnergy() const override { return answers_.field().hasEnergy(); }

  std::vector<Vec3> places(const Nodes& nodes) const override;
  const GridRows& rows() const override { return rows_; }
  const std::vector<double>& masses() const override { return carried_.mass; }
  const fem::FieldAnswers& answers() const override { return answers_; }
  double beyondNodes() const override { return beyond_; }
  std::int64_t renewals() const override { return renewals_; }

  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override;
  double addForcesAndEnergy(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override;
  double energy(const Nodes& nodes, const Instant& now) override;
  void addPattern(linalg::MatrixPattern& pattern) const override;
  void addTangent(const Nodes& nodes, const Instant& now, linalg::BlockMatrix& K) override;
  void addStiffness(const Nodes&, const Instant&, std::span<double>) override {}
  std::optional<fem::StableStep> stableStep(const Nodes& nodes) override;

  double commit(const Nodes& nodes, const Instant& now) override;
  void revert() override { answers_.revert(); }
  bool wantsOtherNodes(const Nodes& nodes) const override;
  double renewNodes(Nodes& nodes, double t) override;
  void addMass(std::span<double> mass) const override;
  void addConsistentMass(linalg::NodeMatrix&) const override;
  void requireValid(const Nodes& nodes, const std::string& when, fem::Scrutiny scrutiny) override;

  bool ownsNodes() const override { return true; }
  void layNodes(Nodes& nodes) override;
  void save(ByteWriter& archive) const override;
  void load(ByteReader& archive) override;

private:
  void ask(const Nodes& nodes, const Instant& now, Wanted wanted);
  void findDeformation(std::span<const Vec3> u);
  void addAnswers(std::span<Vec3> f) const;
  double stored() const;
  std::array<double, 81> moduli(std::size_t p) const;
  void requireSameNodes(const Nodes& nodes) const;

  PointOptions options_;
  fem::FieldAnswers answers_;
  detail::Carried carried_;  // as when the grid was laid out
  std::vector<double> volume_, F0_;
  GridRows rows_;
  std::vector<Vec3> v0_;  // of nodes, m/s
  double beyond_ = 0.0, laidAt_ = 0.0;
  std::int64_t renewals_ = 0;
  bool isNew_ = false;  // nothing was asked since the grid was laid out under points that had answered
};

void Points::requireSameNodes(const Nodes& nodes) const {
  if (nodes.u.size() != rows_.nodes())
    throw InputError(
        "there are " + std::to_string(nodes.u.size()) + " nodes for a grid of " + std::to_string(rows_.nodes()),
        options_.name, "use mpm::makeModel");
}

std::vector<Vec3> Points::places(const Nodes& nodes) const {
  requireSameNodes(nodes);
  std::vector<Vec3> x = carried_.x;
  for (std::size_t p = 0; p < x.size(); ++p) x[p] += valueAt(rows_, p, nodes.u);
  return x;
}

/// F = (1 + Σ u ⊗ ∂w/∂x) F₀.
void Points::findDeformation(std::span<const Vec3> u) {
  const std::span<double> F = answers_.F();
  parallelFor(rows_.points(), pointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      double G[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
      const Vec3* const slope = &rows_.slope[rows_.perPoint * p];
      eachReached(rows_, p, u, [&](std::size_t a, const Vec3& own) {
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) G[3 * i + j] += own[i] * slope[a][j];
      });
      const double* const F0 = &F0_[9 * p];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J)
          F[9 * p + 3 * i + J] = G[3 * i] * F0[J] + G[3 * i + 1] * F0[3 + J] + G[3 * i + 2] * F0[6 + J];
    }
  });
}

/// Unless the points have answered for this state. Those of a new grid have: their state is the one that was accepted.
void Points::ask(const Nodes& nodes, const Instant& now, Wanted wanted) {
  requireSameNodes(nodes);
  wanted.toRead |= isNew_;
  if (answers_.knows(nodes.u, now, wanted)) return;
  findDeformation(nodes.u);
  answers_.ask(nodes.u, now, wanted, options_.name);
}

/// f −= ∂U/∂u, Σ V₀ P F₀ᵀ ∂w/∂x.
void Points::addAnswers(std::span<Vec3> f) const {
  const std::span<const double> P = answers_.P();
  std::vector<double> stress(P.size());
  parallelFor(rows_.points(), pointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          double sum = 0.0;
          for (std::size_t J = 0; J < 3; ++J) sum += P[9 * p + 3 * i + J] * F0_[9 * p + 3 * j + J];
          stress[9 * p + 3 * i + j] = -volume_[p] * sum;
        }
  });
  detail::addToNodes<Vec3>(
      rows_, f,
      [&](std::size_t p, std::size_t a) { return rowTimes(&stress[9 * p], rows_.slope[rows_.perPoint * p + a]); },
      flipped);
}

double Points::stored() const {
  double sum = beyond_;
  for (std::size_t p = 0; p < volume_.size(); ++p) sum += volume_[p] * answers_.energy()[p];
  return sum;
}

void Points::addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) {
  ask(nodes, now, {.energy = !now.willCommit});
  isNew_ = false;
  addAnswers(f);
}

double Points::addForcesAndEnergy(const Nodes& nodes, const Instant& now, std::span<Vec3> f) {
  ask(nodes, now, {});
  isNew_ = false;
  addAnswers(f);
  return stored();
}

double Points::energy(const Nodes& nodes, const Instant& now) {
  ask(nodes, now, {.toRead = true});
  return stored();
}

double Points::commit(const Nodes& nodes, const Instant& now) {
  ask(nodes, now, {.energy = false});
  answers_.commit();
  double sum = 0.0;
  for (std::size_t p = 0; p < volume_.size(); ++p) sum += volume_[p] * answers_.dissipated()[p];
  return sum;
}

void Points::addMass(std::span<double> mass) const {
  const std::vector<double> own = detail::massesOf(rows_, carried_);
  for (std::size_t n = 0; n < own.size(); ++n) mass[n] += own[n];
}

void Points::addConsistentMass(linalg::NodeMatrix&) const {
  throw InputError("material points have lumped masses only", options_.name, "set massFraction to 0");
}

bool Points::wantsOtherNodes(const Nodes& nodes) const {
  const double most = options_.renewal * options_.grid.spacing;
  return std::ranges::any_of(nodes.u, [&](const Vec3& u) { return squaredNorm(u) > most * most; });
}

void Points::layNodes(Nodes& nodes) {
  rows_ = rowsAt(options_.grid, carried_.x, options_.name);
  const std::size_t count = rows_.nodes();
  nodes.X = rows_.X;
  nodes.u.assign(count, {});
  nodes.f.assign(count, {});
  nodes.mass = detail::massesOf(rows_, carried_);
  nodes.fixed = rows_.fixed;
  for (std::size_t n = 0; n < count; ++n)
    if (!(nodes.mass[n] > 0.0)) nodes.fixed[n] = fem::allComponents;
  nodes.v = detail::velocitiesOf(rows_, options_.grid, carried_, nodes.mass);
  v0_ = nodes.v;
  const bool keeps = options_.transfer == Transfer::flip;
  beyond_ = keeps ? detail::kineticEnergy(options_.grid, carried_) - fem::kineticEnergy(nodes) : 0.0;
  answers_.moveTo(nodes.u);
}

void Points::save(ByteWriter& archive) const {
  archive(carried_.x, carried_.v, carried_.moment, F0_, laidAt_, renewals_);
  answers_.save(archive);
}

void Points::load(ByteReader& archive) {
  detail::Carried read = carried_;
  std::vector<double> F0;
  double laidAt = 0.0;
  std::int64_t renewals = 0;
  archive(read.x, read.v, read.moment, F0, laidAt, renewals);
  const auto finite = [](const auto& values) {
    return std::ranges::all_of(values, [](const auto& value) { return std::isfinite(norm2(value)); });
  };
  if (read.x.size() != carried_.x.size() || read.v.size() != carried_.v.size() ||
      read.moment.size() != carried_.moment.size() || F0.size() != F0_.size())
    throw InputError("the state is that of other points", options_.name, "load it into the model that wrote it");
  if (!finite(read.x) || !finite(read.v) || !finite(read.moment) || !finite(F0) || !std::isfinite(laidAt))
    throw InputError("the state is not finite", options_.name, "take an older one");
  answers_.load(archive);
  carried_ = std::move(read);
  F0_ = std::move(F0);
  laidAt_ = laidAt;
  renewals_ = renewals;
  isNew_ = false;
}

double Points::renewNodes(Nodes& nodes, double t) {
  requireSameNodes(nodes);
  const double before = fem::kineticEnergy(nodes) + beyond_;
  const double keep = std::exp(-options_.damping * (t - laidAt_));
  detail::leaveGrid(rows_, nodes.u, nodes.v, v0_, keep, carried_);
  F0_.assign(answers_.F().begin(), answers_.F().end());
  ++renewals_;
  laidAt_ = t;
  layNodes(nodes);
  isNew_ = true;
  return before - (fem::kineticEnergy(nodes) + beyond_);
}

void Points::requireValid(const Nodes& nodes, const std::string& when, fem::Scrutiny) {
  findDeformation(nodes.u);
  const std::span<const double> F = answers_.F();
  for (std::size_t p = 0; p < rows_.points(); ++p) {
    const double* const f = &F[9 * p];
    const double J =
        f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) + f[2] * (f[3] * f[7] - f[4] * f[6]);
    if (!(J > 0.0))
      throw NumericalError("point " + std::to_string(p) + " of \"" + options_.name +
                               "\" is turned inside out (det F = " + formatNumber(J) + ")",
                           when, "take a smaller step, a finer grid or a smaller load");
  }
}

// ---- tangent

/// V₀ ∂(P F₀ᵀ)_ij/∂(∇u)_kl, [9 (3 i + j) + 3 k + l].
std::array<double, 81> Points::moduli(std::size_t p) const {
  std::array<double, 81> A{};
  const double *const T = &answers_.tangent()[81 * p], *const F0 = &F0_[9 * p];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t l = 0; l < 3; ++l) {
          double sum = 0.0;
          for (std::size_t J = 0; J < 3; ++J)
            for (std::size_t L = 0; L < 3; ++L) sum += T[9 * (3 * i + J) + 3 * k + L] * F0[3 * j + J] * F0[3 * l + L];
          A[9 * (3 * i + j) + 3 * k + l] = volume_[p] * sum;
        }
  return A;
}

void Points::addPattern(linalg::MatrixPattern& pattern) const {
  for (std::size_t c = 0; c < rows_.cells(); ++c) {
    const auto own = std::span(rows_.node).subspan(rows_.perPoint * c, rows_.perPoint);
    std::vector<int> nodes(own.begin(), own.end());
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    pattern.add(nodes);
  }
}

/// Of the points of each cell together, which share their nodes.
void Points::addTangent(const Nodes& nodes, const Instant& now, linalg::BlockMatrix& K) {
  ask(nodes, now, {.tangent = true});
  const std::size_t n = rows_.perPoint, size = 3 * n;
  std::vector<double> own(size * size);
  const auto sign = [&](std::size_t entry, std::size_t c) { return rows_.flip[entry] >> c & 1 ? -1.0 : 1.0; };
  for (std::size_t c = 0; c < rows_.cells(); ++c) {
    std::ranges::fill(own, 0.0);
    for (int q = rows_.firstOfCell[c]; q < rows_.firstOfCell[c + 1]; ++q) {
      const auto p = static_cast<std::size_t>(rows_.pointOfCell[static_cast<std::size_t>(q)]);
      const std::array<double, 81> A = moduli(p);
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) {
          const Vec3 &sa = rows_.slope[n * p + a], &sb = rows_.slope[n * p + b];
          for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
              double sum = 0.0;
              for (int j = 0; j < 3; ++j)
                for (int l = 0; l < 3; ++l)
                  sum += A[9 * (3 * i + static_cast<std::size_t>(j)) + 3 * k + static_cast<std::size_t>(l)] * sa[j] *
                         sb[l];
              own[size * (3 * a + i) + 3 * b + k] += sign(n * c + a, i) * sign(n * c + b, k) * sum;
            }
        }
    }
    K.add(std::span(rows_.node).subspan(n * c, n), own);
  }
}

/// Each point with its share m w of the masses of nodes is an element: ω² ≤ λ(A)/m Σ (∂w/∂x)²/w, the latter along the
/// axis where it is largest, λ(A) the largest sum of a row of the moduli.
std::optional<fem::StableStep> Points::stableStep(const Nodes& nodes) {
  ask(nodes, {}, {.tangent = true});
  double largest = 0.0;
  std::size_t worst = 0;
  for (std::size_t p = 0; p < rows_.points(); ++p) {
    const std::array<double, 81> A = moduli(p);
    double rowSum = 0.0;
    for (std::size_t r = 0; r < 9; ++r) {
      double sum = 0.0;
      for (std::size_t s = 0; s < 9; ++s) sum += std::abs(0.5 * (A[9 * r + s] + A[9 * s + r]));
      rowSum = std::max(rowSum, sum);
    }
    Vec3 reach;
    for (std::size_t a = 0; a < rows_.perPoint; ++a) {
      const double weight = rows_.weight[rows_.perPoint * p + a];
      const Vec3& slope = rows_.slope[rows_.perPoint * p + a];
      for (int i = 0; i < 3; ++i)
        if (slope[i] != 0.0) reach[i] += slope[i] * slope[i] / weight;
    }
    const double own = rowSum * std::max({reach.x, reach.y, reach.z}) / carried_.mass[p];
    if (!(own <= largest)) largest = own, worst = p;
    if (std::isnan(own)) break;
  }
  return fem::StableStep{{2.0 / std::sqrt(largest), {}}, static_cast<int>(worst), name(), -1, "point"};
}

void validate(const MaterialPoints& points, const fem::PointField* field, const PointOptions& options) {
  const std::string& name = options.name;
  if (points.x.empty()) throw InputError("there are no points", name, "give some");
  if (points.volume.size() != points.x.size() || (!points.v.empty() && points.v.size() != points.x.size()))
    throw InputError("there are " + std::to_string(points.x.size()) + " places, " + std::to_string(points.v.size()) +
                         " velocities and " + std::to_string(points.volume.size()) + " volumes",
                     name, "give one of each per point, or no velocities");
  for (std::size_t p = 0; p < points.x.size(); ++p) {
    const std::string where = "point " + std::to_string(p) + " of \"" + name + "\"";
    if (!isFinite(points.x[p]) || (!points.v.empty() && !isFinite(points.v[p])))
      throw InputError("its place or velocity is not finite", where, "give numbers");
    if (options.grid.plane && points.x[p].z != 0.0)
      throw InputError("it lies at z = " + formatNumber(points.x[p].z) + " m", where, "give z = 0 in the plane");
    requirePositive(points.volume[p], "volume of " + where);
  }
  if (field == nullptr) throw InputError("there is no material", name, "give a field from fem::pointField()");
  validate(options.grid);
  requireNonNegative(options.damping, "damping of points");
  if (!(options.renewal > 0.0 && options.renewal <= 0.5))
    throw InputError("renewal is " + formatNumber(options.renewal), name, "give a number above 0, up to 0.5");
  if (options.transfer == Transfer::apic && secondMoment(options.grid.shape) == 0.0)
    throw InputError(std::string("apic with ") + mpm::name(options.grid.shape) + " shapes", name,
                     "take quadratic or cubic ones, or flip");
}

}  // namespace

std::shared_ptr<PointSolid> makePoints(const MaterialPoints& points, std::shared_ptr<fem::PointField> field,
                                       const PointOptions& options) {
  validate(points, field.get(), options);
  return std::make_shared<Points>(points, std::move(field), options);
}

fem::Model makeModel(std::shared_ptr<PointSolid> points) {
  if (points == nullptr) throw InputError("there are no points", "mpm::makeModel", "give those of makePoints");
  fem::Model model;
  points->layNodes(model.nodes);
  model.add(std::move(points));
  return model;
}

}  // namespace dovetail::mpm
