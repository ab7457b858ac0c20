#include "events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/setup/insertion.hpp"

namespace dovetail::dem {

namespace {

std::string name(const Particles& particles, std::size_t i) { return "particle " + std::to_string(particles.id[i]); }

std::string state(const Particles& particles, std::size_t i) {
  const auto text = [](const Vec3& v) {
    return "(" + formatNumber(v.x) + ", " + formatNumber(v.y) + ", " + formatNumber(v.z) + ")";
  };
  return "at " + text(particles.x[i]) + " m with " + text(particles.v[i]) + " m/s";
}

bool inside(const Domain& domain, const geometry::Periodicity& space, const Vec3& x) {
  for (int k = 0; k < 3; ++k)
    if (!space.axes[static_cast<std::size_t>(k)] && !(x[k] >= domain.box.lower[k] && x[k] <= domain.box.upper[k]))
      return false;
  return true;
}

/// Numbers of the particles that `is` picks, ascending.
template <class Is>
std::vector<int> thoseOf(std::size_t particles, Is&& is) {
  constexpr std::size_t chunkSize = 8192;
  std::vector<std::vector<int>> parts((particles + chunkSize - 1) / chunkSize);
  parallelFor(particles, chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (is(i)) parts[begin / chunkSize].push_back(static_cast<int>(i));
  });
  std::vector<int> those;
  for (const auto& part : parts) those.insert(those.end(), part.begin(), part.end());
  return those;
}

void letEscape(Model& m) {
  if (!m.domain) return;
  const std::vector<int> out = thoseOf(
      m.particles.size(), [&](std::size_t i) { return !inside(*m.domain, m.pairs.periodicity(), m.particles.x[i]); });
  if (out.empty()) return;
  const auto first = static_cast<std::size_t>(out.front());
  if (m.domain->policy == EscapePolicy::refuse)
    throw NumericalError("it has left the domain, " + when(m) + ", " + state(m.particles, first) + " (" +
                             std::to_string(out.size()) + " in all)",
                         name(m.particles, first),
                         "take a smaller time step, a larger domain, or the policy that removes particles");
  removeParticles(m, out);
  findPairs(m.particles, m.pairs);
}

void sort(Model& m) {
  const std::vector<int> newNumber = sortParticles(m.particles, m.pairs);
  for (const auto& term : m.terms) term->renumber(newNumber, m.particles);
}

/// A contact counts as much as its particles do: the mean of their weights.
void weighPairs(Model& m) {
  const Particles& p = m.particles;
  if (p.weight.empty()) return;
  const std::span<double> factors = m.pairs.writeFactors();
  parallelFor(m.pairs.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto& [i, j] = m.pairs.pairs()[k];
      factors[k] = 0.5 * (p.weight[static_cast<std::size_t>(i)] + p.weight[static_cast<std::size_t>(j)]);
    }
  });
}

/// Laws that bond the pairs of a list keep the list that they were given.
bool keepsPairs(const Model& m) { return m.laws && std::isinf(m.laws->reach()); }

/// Whether moves by whole periods change the energy in gravity.
bool wrapsLift(const Model& m) {
  for (int k = 0; k < 3; ++k)
    if (m.pairs.periodicity().axes[static_cast<std::size_t>(k)] && m.gravity[k] != 0.0) return true;
  return false;
}

/// What the moves from `before` to where particles are now have given them in gravity, J; bodies book theirs.
double liftedFrom(const std::vector<Vec3>& before, const Model& m) {
  const Particles& p = m.particles;
  return parallelSum(p.size(), 4096, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i)
      if (!p.isMember(i)) sum -= p.weightOf(i) * p.mass[i] * dot(m.gravity, p.x[i] - before[i]);
    return sum;
  });
}

void updateAndBookWraps(Model& m) {
  PairList& list = m.pairs;
  if (!list.maySearch(m.particles, m.step.moved) || !wrapsLift(m)) {
    updatePairs(m.particles, list, m.step.moved);
    return;
  }
  const std::vector<Vec3> before = m.particles.x;
  const std::int64_t wraps = m.particles.wraps;
  updatePairs(m.particles, list, m.step.moved);
  if (m.particles.wraps != wraps) m.booked.lifted += liftedFrom(before, m);
}

}  // namespace

bool hasForces(const Model& m) {
  return m.forcesOf == m.particles.revision && m.forcesOfTerms == m.terms.revision() && m.forcesOfLaws == m.laws;
}

void setFactors(Model& m) {
  weighPairs(m);
  for (const auto& term : m.terms) term->neighbourListUpdated(m);
}

std::string when(const Model& m) { return "t = " + formatNumber(m.time) + " s, step " + std::to_string(m.steps); }

double smallestRadius(const Particles& particles) {
  return particles.size() == 0 ? 0.0 : *std::min_element(particles.radius.begin(), particles.radius.end());
}

double largestSpeed(const Particles& particles) {
  constexpr std::size_t chunkSize = 4096;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const auto sum = [](const Vec3& a) { return a.x + a.y + a.z; };
  const bool spins = particles.rotates();
  const double squared = parallelMax(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double largest = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const double poison = sum(particles.x[i]) + particles.radius[i] + (spins ? sum(particles.omega[i]) : 0.0);
      const double v2 = squaredNorm(particles.v[i]) + 0.0 * poison;
      if (!(v2 <= largest)) largest = std::isfinite(v2) ? v2 : infinite;
    }
    return largest;
  });
  return std::sqrt(squared);
}

void requireShortMoves(const Particles& particles, double dt, const std::string& when) {
  const std::vector<int> thrown = thoseOf(particles.size(), [&](std::size_t i) {
    return !(norm(particles.v[i]) * dt <= particles.radius[i]) || !isFinite(particles.x[i]) ||
           (particles.rotates() && !isFinite(particles.omega[i]));
  });
  if (thrown.empty()) return;
  requireFinite(particles, when);
  const auto i = static_cast<std::size_t>(thrown.front());
  throw NumericalError("it moved farther than its radius in one step, " + when + ", " + state(particles, i),
                       name(particles, i), "take a smaller time step, or check the forces on it");
}

double bookParticle(const Model& m, std::size_t i, Exchanged& exchanged) {
  const Particles& p = m.particles;
  const double mass = p.weightOf(i) * p.mass[i], half = 0.5 * m.open;
  const Vec3 v = p.v[i] + (half / mass) * p.f[i];
  ++exchanged.count;
  exchanged.mass += mass;
  exchanged.momentum += mass * v;
  exchanged.angularMomentum += cross(p.x[i], mass * v);
  const double energy = 0.5 * mass * squaredNorm(v) + gravityOf(p, i, m.gravity);
  if (!p.rotates()) return energy;
  const double inertia = p.weightOf(i) * momentOfInertia(p, static_cast<int>(i));
  const Vec3 spin = p.omega[i] + (half / inertia) * p.torque[i];
  exchanged.angularMomentum += inertia * spin;
  return energy + 0.5 * inertia * squaredNorm(spin);
}

double gravityOf(const Particles& p, std::size_t i, const Vec3& gravity) {
  return -p.weightOf(i) * p.mass[i] * dot(gravity, p.x[i]);
}

double reachOfPairs(const Model& m) { return m.laws && !keepsPairs(m) ? m.laws->reach() : 0.0; }

void updatePairs(Model& m) {
  m.pairs.setReach(reachOfPairs(m));
  const std::int64_t builds = m.pairs.builds(), revision = m.pairs.revision();
  if (keepsPairs(m) && builds > 0)
    keepPairs(m.particles, m.pairs);
  else
    updateAndBookWraps(m);
  if (m.pairs.builds() != builds) {
    letEscape(m);
    if (m.sortEvery > 0 && m.listUpdates++ % m.sortEvery == 0) sort(m);
  }
  if (m.pairs.revision() != revision) setFactors(m);
}

namespace {
/// @return J that the contacts of those who go had stored
double renumberPairs(Model& m, std::span<const int> newNumber) {
  EndedPairs earlier = m.pairs.takeEnded();
  renumber(m.pairs, newNumber, m.particles);
  const EndedPairs gone = m.pairs.takeEnded();
  m.pairs.putEnded(std::move(earlier));
  return m.laws && m.booking == Booking::on ? m.laws->held(gone) : 0.0;
}
}  // namespace

void removeParticles(Model& m, std::span<const int> list) {
  if (list.empty()) return;
  std::vector<char> leaves(m.particles.size(), 0);
  const std::vector<int> asked = numbersWithout(m.particles, list);
  for (std::size_t i = 0; i < asked.size(); ++i) leaves[i] = asked[i] < 0;
  for (const auto& term : m.terms) term->leaving(m, leaves);
  std::vector<int> all;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (leaves[i] != 0) all.push_back(static_cast<int>(i));
    if (leaves[i] == 1) m.booked.left += bookParticle(m, i, m.left);
  }
  const std::vector<int> newNumber = numbersWithout(m.particles, all);
  double held = renumberPairs(m, newNumber);
  for (const auto& term : m.terms) held += term->renumber(newNumber, m.particles);
  m.booked.left += held;
  m.work.elasticEnergy -= held;
  renumber(m.particles, newNumber);
}

void admitParticles(Model& m, std::size_t first) {
  m.newcomersTouch = true;
  for (std::size_t i = first; i < m.particles.size(); ++i) {
    m.booked.entered += bookParticle(m, i, m.entered);
    m.particles.f[i] = (m.particles.weightOf(i) * m.particles.mass[i]) * m.gravity;
    m.smallestRadius = std::min(m.smallestRadius, m.particles.radius[i]);
    m.newcomers.push_back(m.particles.id[i]);
  }
}

}  // namespace dovetail::dem
