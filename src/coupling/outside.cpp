#include "outside.hpp"

#include "dovetail/dem/bodies/body_term.hpp"

namespace dovetail::coupling {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// dt times the forces on a particle.
Momenta kickOf(const dem::Particles& p, std::size_t i, double dt) {
  Momenta kick;
  kick.add(p.x[i], dt * p.f[i]);
  if (p.rotates()) kick.angular += dt * p.torque[i];
  return kick;
}

std::pair<std::string, Momenta> read(ByteReader& archive) {
  std::pair<std::string, Momenta> one;
  archive(one.first, one.second);
  return one;
}

}  // namespace

void Outside::giveHalf(double dt) {
  for (Source& source : forces_) given.give(source.name, 0.5 * dt * source.force, source.channel);
}

/// Sources come in the same order at every evaluation, or nearly so: their strings stay where they are.
void Outside::put(const std::string& name, const Momenta& force) {
  if (put_ == forces_.size()) forces_.emplace_back();
  Source& source = forces_[put_++];
  if (source.name != name) source = {name, {}};
  source.force = force;
}

void Outside::begin(double dt) {
  giveHalf(dt);
  underWay_ = true;
}

void Outside::evaluated(const dem::Model& m, const dem::Step& step, const Momenta& onSolids) {
  static const std::string gravity = "particles: gravity";
  put_ = 0;
  put(gravity, dem::weight(m));
  takeCounted(m, true);
  if (onSolids != Momenta{}) put("staggering error", -1.0 * onSolids);
  forces_.resize(put_);
  if (step.timeless) return;
  giveHalf(step.dt);
  underWay_ = false;
  // Those who came in have the velocities of this moment: the half kick that is due is not for them.
  if (m.newcomers.empty()) return;
  for (const std::int64_t id : m.newcomers)
    if (const int i = dem::find(m.particles, id); i >= 0 && !m.particles.isMember(at(i)))
      given.give("entered", kickOf(m.particles, at(i), -0.5 * step.dt));
}

void Outside::left(const dem::Model& m, std::span<const int> newNumber, const dem::Particles& before) {
  if (!underWay_) return;
  for (std::size_t i = 0; i < newNumber.size(); ++i)
    if (newNumber[i] < 0 && !before.isMember(i)) given.give("particles: gravity", kickOf(before, i, 0.5 * m.open));
}

void Outside::takeCounted(const dem::Model& m) { takeCounted(m, false); }

/// What terms count themselves is given up to now.
void Outside::takeCounted(const dem::Model& m, bool withForces) {
  std::map<std::string, Momenta> now;
  for (const auto& term : m.terms) {
    Momenta force, counted;
    term->addOutside(m, force, counted);
    if (force == Momenta{} && counted == Momenta{}) continue;
    const std::string name = "particles: " + term->name();
    if (withForces && force != Momenta{}) put(name, force);
    if (counted != Momenta{}) now[name] += counted;
  }
  for (const auto& [name, counted] : now) given.give(name, counted - counted_[name]);
  counted_ = std::move(now);
}

void Outside::save(ByteWriter& archive) const {
  archive(opening, massAtOpening, entered, gone, static_cast<std::uint64_t>(forces_.size()),
          static_cast<std::uint64_t>(counted_.size()));
  for (const Source& source : forces_) archive(source.name, source.force);
  for (const auto& [name, impulse] : counted_) archive(name, impulse);
  given.save(archive);
}

void Outside::load(ByteReader& archive) {
  std::uint64_t forces = 0, counted = 0;
  archive(opening, massAtOpening, entered, gone, forces, counted);
  forces_.clear();
  counted_.clear();
  for (std::uint64_t k = 0; k < forces; ++k) {
    auto [name, force] = read(archive);
    forces_.push_back({std::move(name), force});
  }
  for (std::uint64_t k = 0; k < counted; ++k) counted_.insert(read(archive));
  given.load(archive);
}

}  // namespace dovetail::coupling
