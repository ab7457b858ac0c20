#include "contact_batch.hpp"

#include <cmath>

#include "dovetail/core/vector_code.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"

namespace dovetail::python {

using dem::detail::blockSize, dem::detail::ContactBlock, dem::detail::PairCursor, dem::detail::PairParts,
    dem::detail::PairRows;

unsigned LawTraits::turns() const {
  unsigned bits = 0;
  for (const int c : vectors) bits |= 0b111u << c;
  return bits;
}

void Batch::start(std::size_t contacts, std::size_t columns, double step) {
  count = contacts;
  dt = step;
  given.resize(columns * contacts);
  answered.assign(answers * contacts, 0.0);
  first.resize(contacts);
  second.resize(contacts);
}

namespace {

bool isFelt(const LawTraits& law, double overlap, double scale) { return overlap > -law.reach && scale > 0.0; }

/// For the passes over contacts: how far the law reaches, m.
struct Reach {
  double range = 0.0;
  double reach() const { return range; }
};
struct LawReach : Reach {
  Reach normal;
  const LawReach& at(std::size_t) const { return *this; }
};

template <bool rolls>
struct Traits {
  static constexpr bool needsSpin = rolls, jumps = true;
};

/// Velocities at the instant of the force, and what counts of the step; what is remembered of velocities moves on.
template <bool wall>
void lookAhead(const LawTraits& law, ContactBlock& block, std::size_t n, double dt) {
  constexpr dem::detail::BlockOptions options{true, wall, true, true, dem::Recall::motion};
  const LawReach laws{{law.reach}, {}};
  const bool kinks = law.rotates ? dem::detail::lookAhead<Traits<true>, options>(block, n, laws, dt)
                                 : dem::detail::lookAhead<Traits<false>, options>(block, n, laws, dt);
  if (kinks) dem::detail::engage<Traits<true>>(block, n, laws, dt);
}

/// Appends what a law is given of a contact, in the order of the columns.
void appendRow(const LawTraits& law, const ContactBlock& block, std::size_t l, double rootMass, double dt,
               std::vector<double>& rows) {
  const Vec3 normal = block.normal.at(l), velocity = block.velocity.at(l);
  const Vec3 spin = law.rotates ? block.spinDifference.at(l) : Vec3{},
             spinNow = law.rotates ? block.spin.at(l) : Vec3{};
  const double overlap = block.overlap[l], separating = dot(normal, velocity), moving = block.share[l] * dt;
  const Vec3 slipped = moving * (velocity - separating * normal), turned = moving * spin;
  rows.insert(rows.end(),
              {overlap, overlap + separating * dt, block.separating[l], rootMass * rootMass, block.effectiveRadius[l]});
  for (const Vec3& vector : {normal, block.slip.at(l), spinNow})
    rows.insert(rows.end(), {vector.x, vector.y, vector.z});
  rows.push_back(moving * separating);
  for (const Vec3& vector : {slipped, turned}) rows.insert(rows.end(), {vector.x, vector.y, vector.z});
  rows.insert(rows.end(), {block.engagement[l], block.engagementUntilEnd[l]});
  for (int c = 0; c < law.kept(); ++c) rows.push_back(block.memory[static_cast<std::size_t>(c)][l]);
}

void carryVectors(const LawTraits& law, ContactBlock& block, std::size_t n, double dt) {
  for (const int c : law.vectors) dem::detail::carry(block, n, static_cast<std::size_t>(c), dt);
}

/// Rows to columns, from contact number `begin` on.
void layDown(const std::vector<double>& rows, std::size_t columns, std::size_t begin, Batch& batch) {
  for (std::size_t c = 0; c < columns; ++c) {
    double* const to = batch.givenColumn(c) + begin;
    for (std::size_t k = 0, count = rows.size() / columns; k < count; ++k) to[k] = rows[k * columns + c];
  }
}

/// One sweep over pairs.
struct Sweep {
  const LawTraits& law;
  dem::Particles& particles;
  PairParts& list;
  PairRows rows;
  double dt;
  Batch& batch;

  struct Part {
    std::vector<double> rows;
    std::vector<int> first, second;
    double lost = 0.0;  ///< W
  };

  double scaleOf(const ContactBlock& block, std::size_t l) const { return rows.varied ? block.scale[l] : 1.0; }

  void meet(ContactBlock& block, std::size_t n) const {
    withVectors([&] {
      law.rotates ? dem::detail::meet<true, dem::Recall::motion>(block, n, dt)
                  : dem::detail::meet<false, dem::Recall::motion>(block, n, dt);
    });
  }

  /// A pair that does not touch forgets.
  double forget(ContactBlock& block, std::size_t l, double scale) const {
    const double lost = scale * block.memory[static_cast<std::size_t>(law.memory) + 1][l];
    for (int c = 0; c < law.kept(); ++c) block.memory[static_cast<std::size_t>(c)][l] = 0.0;
    for (int c = 0; c < rows.motion; ++c) block.motion[static_cast<std::size_t>(c)][l] = 0.0;
    return lost / dt;
  }

  Part gather(std::size_t chunk) const {
    ContactBlock block;
    dem::detail::shareSizes(particles, rows, block);
    Part part;
    PairCursor cursor = dem::detail::startOfChunk(particles, list, rows, chunk);
    part.rows.reserve((cursor.end - cursor.pair) * (Batch::memory + static_cast<std::size_t>(law.kept())));
    while (cursor.pair < cursor.end) {
      const std::size_t n = dem::detail::gatherPairs(particles, list, rows, cursor, block);
      meet(block, n);
      lookAhead<false>(law, block, n, dt);
      carryVectors(law, block, n, dt);
      for (std::size_t l = 0; l < n; ++l) {
        const double scale = scaleOf(block, l);
        if (!isFelt(law, block.overlap[l], scale)) {
          part.lost += forget(block, l, scale);
          continue;
        }
        appendRow(law, block, l, rows.varied ? block.rootMass[l] / std::sqrt(scale) : block.rootMass[l], dt, part.rows);
        part.first.push_back(list.pairs[cursor.pair + l][0]);
        part.second.push_back(list.pairs[cursor.pair + l][1]);
      }
      cursor.pair += n;
    }
    return part;
  }

  /// The answers of a chunk's contacts from number k on, to its block.
  dem::ContactWork answerBlock(ContactBlock& block, std::size_t n, std::size_t& k) const {
    dem::ContactWork work;
    for (std::size_t l = 0; l < n; ++l) {
      const double scale = scaleOf(block, l), overlap = block.overlap[l];
      const bool here = isFelt(law, overlap, scale);
      const Vec3 force = here ? scale * batch.answer(Batch::force, k) : Vec3{};
      block.force.set(l, force);
      if (law.rotates) {
        const Vec3 couple = here ? scale * batch.answer(Batch::couple, k) : Vec3{};
        const Vec3 turning = cross(force, block.normal.at(l));
        block.torqueI.set(l, (block.radiusI[l] - 0.5 * overlap) * turning + couple);
        block.torqueJ.set(l, (block.radiusJ[l] - 0.5 * overlap) * turning - couple);
      }
      if (!here) continue;
      for (int c = 0; c < law.kept(); ++c)
        block.memory[static_cast<std::size_t>(c)][l] =
            batch.givenColumn(Batch::memory + static_cast<std::size_t>(c))[k];
      work.elasticEnergy += scale * batch.answerColumn(Batch::elastic)[k];
      work.tangentialEnergy += scale * batch.answerColumn(Batch::tangential)[k];
      work.dissipatedPower += scale * batch.answerColumn(Batch::dissipated)[k];
      work.frictionPower += scale * batch.answerColumn(Batch::friction)[k];
      ++k;
    }
    return work;
  }

  dem::ContactWork scatter(std::size_t chunk, std::size_t k) const {
    ContactBlock block;
    dem::detail::shareSizes(particles, rows, block);
    dem::ContactWork work;
    PairCursor cursor = dem::detail::startOfChunk(particles, list, rows, chunk);
    while (cursor.pair < cursor.end) {
      const std::size_t n = dem::detail::gatherPairs(particles, list, rows, cursor, block);
      meet(block, n);
      work += answerBlock(block, n, k);
      dem::detail::scatterPairs(list, rows, n, cursor, block);
    }
    dem::detail::finishChunk(particles, list, rows, cursor);
    return work;
  }
};

PairRows rowsFor(const LawTraits& law, const dem::Particles& particles, const PairParts& list) {
  PairRows rows{.spins = law.rotates,
                .rolls = true,
                .mass = true,
                .radius = true,
                .memory = law.kept(),
                .motion = law.numbers() - law.kept()};
  dem::detail::findUniform(particles, rows);
  rows.varied = !list.factors.empty();
  return rows;
}

/// Fills the batch; returns with which number each chunk begins.
std::vector<std::size_t> join(const std::vector<Sweep::Part>& parts, const LawTraits& law, double dt, Batch& batch) {
  const std::size_t columns = Batch::memory + static_cast<std::size_t>(law.kept());
  std::vector<std::size_t> begin(parts.size() + 1, 0);
  for (std::size_t p = 0; p < parts.size(); ++p) begin[p + 1] = begin[p] + parts[p].first.size();
  batch.start(begin.back(), columns, dt);
  parallelFor(parts.size(), 1, [&](std::size_t p, std::size_t) {
    layDown(parts[p].rows, columns, begin[p], batch);
    std::ranges::copy(parts[p].first, batch.first.begin() + static_cast<std::ptrdiff_t>(begin[p]));
    std::ranges::copy(parts[p].second, batch.second.begin() + static_cast<std::ptrdiff_t>(begin[p]));
  });
  return begin;
}

/// Energies go into the memory, for the step in which the contact ends.
void keepEnergies(const LawTraits& law, Batch& batch) {
  const auto own = static_cast<std::size_t>(law.memory);
  std::copy_n(batch.answerColumn(Batch::elastic), batch.count, batch.givenColumn(Batch::memory + own));
  std::copy_n(batch.answerColumn(Batch::tangential), batch.count, batch.givenColumn(Batch::memory + own + 1));
}

}  // namespace

dem::ContactWork answerPairs(const LawTraits& law, dem::Particles& particles, dem::PairList& list, double dt,
                             dem::Booking booking, Batch& batch, const Ask& ask) {
  dem::detail::requireStep(dt);
  list.prepareMemory(law.kept(), law.turns(), law.memoryKind());
  list.prepareMotion(law.numbers() - law.kept(), true);
  PairParts& pairs = dem::detail::partsOf(list);
  const Sweep sweep{law, particles, pairs, rowsFor(law, particles, pairs), dt, batch};
  if (law.rotates) pairs.chunks.torque.resize(pairs.chunks.force.size());
  std::vector<Sweep::Part> parts(pairs.chunks.count());
  parallelFor(parts.size(), 1, [&](std::size_t chunk, std::size_t) { parts[chunk] = sweep.gather(chunk); });
  const std::vector<std::size_t> begin = join(parts, law, dt, batch);
  if (batch.count > 0) ask(batch);
  keepEnergies(law, batch);
  dem::ContactWork work =
      parallelSum(parts.size(), 1, [&](std::size_t chunk, std::size_t) { return sweep.scatter(chunk, begin[chunk]); });
  dem::detail::addCrossing(particles, pairs, law.rotates && particles.rotates());
  for (const Sweep::Part& part : parts) work.frictionPower += part.lost;
  const dem::ContactWork left = energyOf(law, list.takeEnded());
  work.frictionPower += left.frictionPower / dt;
  work.fracturePower += left.fracturePower / dt;
  return booking == dem::Booking::on ? work : dem::ContactWork{};
}

WallBatch::WallBatch(const LawTraits& law, double dt, std::size_t contacts, Batch& batch)
    : law_(law), dt_(dt), batch_(batch) {
  batch_.first.clear();
  scales_.reserve(contacts);
  energyScales_.reserve(contacts);
  places_.reserve(contacts);
}

double WallBatch::take(ContactBlock& block, std::size_t n, std::span<const int> particle, double* memory) {
  const auto kept = static_cast<std::size_t>(law_.kept()), numbers = static_cast<std::size_t>(law_.numbers());
  std::array<ContactBlock::Row, 12> held;
  std::array<ContactBlock::Row, 6> moved;
  block.recalls = numbers > kept;
  for (std::size_t m = 0; m < kept; ++m) {
    block.memory[m] = held[m].data();
    for (std::size_t l = 0; l < n; ++l) held[m][l] = memory[l * numbers + m];
  }
  for (std::size_t m = kept; m < numbers; ++m) {
    block.motion[m - kept] = moved[m - kept].data();
    for (std::size_t l = 0; l < n; ++l) moved[m - kept][l] = memory[l * numbers + m];
  }
  lookAhead<true>(law_, block, n, dt_);
  carryVectors(law_, block, n, dt_);
  double lost = 0.0;
  for (std::size_t l = 0; l < n; ++l) {
    const bool here = isFelt(law_, block.overlap[l], block.scale[l]);
    scales_.push_back(block.scale[l]);
    energyScales_.push_back(block.energyFraction[l]);
    places_.push_back(here ? static_cast<int>(batch_.first.size()) : -1);
    if (here) {
      appendRow(law_, block, l, block.rootMass[l], dt_, rows_);
      batch_.first.push_back(particle[l]);
    } else {
      lost += block.scale[l] * held[kept - 1][l] / dt_;
    }
    for (std::size_t m = kept; m < numbers; ++m) memory[l * numbers + m] = here ? moved[m - kept][l] : 0.0;
  }
  return lost;
}

void WallBatch::ask(const Ask& ask) {
  const std::size_t columns = Batch::memory + static_cast<std::size_t>(law_.kept());
  batch_.start(batch_.first.size(), columns, dt_);
  std::ranges::fill(batch_.second, -1);
  layDown(rows_, columns, 0, batch_);
  if (batch_.count > 0) ask(batch_);
  keepEnergies(law_, batch_);
}

bool WallBatch::acts(std::size_t c, std::size_t& index) const {
  index = static_cast<std::size_t>(std::max(places_[c], 0));
  return places_[c] >= 0;
}

dem::ContactWork energyOf(const LawTraits& law, const dem::EndedPairs& left) {
  const auto numbers = static_cast<std::size_t>(law.kept());
  dem::ContactWork joules;
  if (left.memory.size() != numbers * left.pairs.size()) return joules;  // of another law
  for (std::size_t k = 0; k < left.pairs.size(); ++k) {
    const double* const energies = left.memory.data() + k * numbers + law.memory;
    joules.frictionPower += left.pairs[k].factor * energies[1];
    if (left.pairs[k].overlap > -law.reach) joules.fracturePower += left.pairs[k].factor * energies[0];
  }
  return joules;
}

double powerOf(const LawTraits& law, const dem::EndedMemories& ended, double dt) {
  const auto numbers = static_cast<std::size_t>(law.numbers()), tangential = static_cast<std::size_t>(law.memory) + 1;
  double lost = 0.0;
  if (ended.memory.size() != numbers * ended.material.size()) return lost;  // of another law
  for (std::size_t k = 0; k < ended.material.size(); ++k)
    lost += ended.fraction[k] * ended.memory[k * numbers + tangential] / dt;
  return lost;
}

}  // namespace dovetail::python
