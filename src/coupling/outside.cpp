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

void write(ByteWriter& archive, const std::string& name, const Momenta& value) {
  archive(std::vector<char>(name.begin(), name.end()), value);
}

std::pair<std::string, Momenta> read(ByteReader& archive) {
  std::vector<char> name;
  Momenta value;
  archive(name, value);
  return {{name.begin(), name.end()}, value};
}

}  // namespace

void Outside::giveHalf(double dt) {
  for (const auto& [name, force] : forces_) given.give(name, 0.5 * dt * force);
}

void Outside::begin(double dt) {
  giveHalf(dt);
  underWay_ = true;
}

void Outside::evaluated(const dem::Model& m, const dem::Step& step, const Momenta& onSolids) {
  forces_.clear();
  forces_.emplace_back("particles: gravity", dem::weight(m));
  collect(m, forces_);
  if (onSolids != Momenta{}) forces_.emplace_back("loads one step old", -1.0 * onSolids);
  if (step.timeless) return;
  giveHalf(step.dt);
  underWay_ = false;
  // Those who came in have the velocities of this moment: the half kick that is due is not for them.
  const std::vector<char> inBodies = dem::members(m);
  for (const std::int64_t id : m.newcomers)
    if (const int i = dem::find(m.particles, id); i >= 0 && (inBodies.empty() || inBodies[at(i)] == 0))
      given.give("entered", kickOf(m.particles, at(i), -0.5 * step.dt));
}

void Outside::left(const dem::Model& m, std::span<const int> newNumber, const dem::Particles& before) {
  if (!underWay_) return;
  const std::vector<char> inBodies = dem::members(m);
  for (std::size_t i = 0; i < newNumber.size(); ++i)
    if (newNumber[i] < 0 && (inBodies.empty() || inBodies[i] == 0))
      given.give("particles: gravity", kickOf(before, i, 0.5 * m.open));
}

void Outside::takeCounted(const dem::Model& m) {
  Forces forces;
  collect(m, forces);
}

/// Forces of the terms; what they count themselves is given up to now.
void Outside::collect(const dem::Model& m, Forces& forces) {
  std::map<std::string, Momenta> now;
  for (const auto& term : m.terms) {
    Momenta force, counted;
    term->addOutside(m, force, counted);
    const std::string name = "particles: " + term->name();
    if (force != Momenta{}) forces.emplace_back(name, force);
    if (counted != Momenta{}) now[name] += counted;
  }
  for (const auto& [name, counted] : now) given.give(name, counted - counted_[name]);
  counted_ = std::move(now);
}

void Outside::save(ByteWriter& archive) const {
  archive(opening, massAtOpening, entered, gone, static_cast<std::uint64_t>(forces_.size()),
          static_cast<std::uint64_t>(counted_.size()));
  for (const auto& [name, force] : forces_) write(archive, name, force);
  for (const auto& [name, impulse] : counted_) write(archive, name, impulse);
  given.save(archive);
}

void Outside::load(ByteReader& archive) {
  std::uint64_t forces = 0, counted = 0;
  archive(opening, massAtOpening, entered, gone, forces, counted);
  forces_.clear();
  counted_.clear();
  for (std::uint64_t k = 0; k < forces; ++k) forces_.push_back(read(archive));
  for (std::uint64_t k = 0; k < counted; ++k) counted_.insert(read(archive));
  given.load(archive);
}

}  // namespace dovetail::coupling
