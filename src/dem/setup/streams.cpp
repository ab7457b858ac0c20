#include "dovetail/dem/setup/streams.hpp"

#include <algorithm>
#include <string>

#include "../model/events.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/walls.hpp"

namespace dovetail::dem {

namespace {

Surroundings surroundingsOf(const Model& m) {
  Surroundings around{m.pairs.periodicity()};
  for (const auto& term : m.terms) term->surround(around);
  return around;
}

/// Of the step, in which the insertion goes on, s.
double activePart(const InsertionOptions& s, const Step& step) {
  const double begin = step.time - step.dt;
  if (begin >= s.from && step.time <= s.until) return step.dt;
  return std::max(0.0, std::min(step.time, s.until) - std::max(begin, s.from));
}

bool inside(const geometry::Box& box, const Vec3& x) {
  for (int k = 0; k < 3; ++k)
    if (!(x[k] >= box.lower[k] && x[k] <= box.upper[k])) return false;
  return true;
}
bool inside(const HalfSpace& space, const Vec3& x) { return dot(x - space.point, space.normal) > 0.0; }

geometry::Box widened(const geometry::Box& box, double by) {
  const Vec3 all{by, by, by};
  return {box.lower - all, box.upper + all};
}
HalfSpace widened(const HalfSpace& space, double by) {
  return {space.point - by * normalized(space.normal), space.normal};
}

std::vector<int> particlesIn(const Particles& particles, const OutletTerm::Region& region) {
  std::vector<char> in(particles.size(), 0);
  parallelFor(in.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::visit(
        [&](const auto& r) {
          for (std::size_t i = begin; i < end; ++i) in[i] = inside(r, particles.x[i]);
        },
        region);
  });
  std::vector<int> list;
  for (std::size_t i = 0; i < in.size(); ++i)
    if (in[i] != 0) list.push_back(static_cast<int>(i));
  return list;
}

void requireValid(const geometry::Box& box) {
  for (int k = 0; k < 3; ++k)
    if (!(box.lower[k] <= box.upper[k]))
      throw InputError(std::string("the lower corner lies above the upper one along axis ") + "xyz"[k], "outlet",
                       "give a box with lower ≤ upper");
}
void requireValid(const HalfSpace& space) {
  if (!isFinite(space.point) || !isFinite(space.normal) || !(squaredNorm(space.normal) > 0.0))
    throw InputError("the plane is not valid", "outlet", "give a finite point, and a normal of any length but 0");
}

}  // namespace

void InsertionTerm::check(const Model& m) const {
  requireLaws(m);
  const InsertionOptions& s = insertion.settings;
  const int shapes = static_cast<int>(s.shapes.size());
  for (const ClumpShape& shape : s.shapes) requireShorter(shape, m.pairs.periodicity(), "clumps of an insertion");
  if (insertion.nextShape < 0 || insertion.nextShape >= std::max(1, shapes))
    throw InputError("there is no shape " + std::to_string(insertion.nextShape) + " of " + std::to_string(shapes),
                     "insertion", "take an older checkpoint");
  if (squaredNorm(s.spin) > 0.0 && m.particles.size() > 0 && !m.particles.rotates())
    throw InputError("the particles do not spin", "spin of inserted particles", "call switchOnRotation before");
  if (m.laws && m.laws->materials() > 1 && s.material >= m.laws->materials())
    throw InputError("there is no law for material " + std::to_string(s.material), "insertion",
                     "give a row of the table of laws");
}

void InsertionTerm::exchange(Model& m, const Step& step) {
  const double active = activePart(insertion.settings, step);
  if (insertion.settings.replacesLeavers) {
    if (active > 0.0) insertion.due += static_cast<double>(m.left.count - replaced_);
    replaced_ = m.left.count;
  }
  if (active == 0.0 || isComplete(insertion)) return;
  const auto rotate = [&] {
    if (m.rotation == Rotation::automatic && m.laws && m.laws->rotates()) switchOnRotation(m.particles);
  };
  const bool touching = m.newcomersTouch;
  const Surroundings around = surroundingsOf(m);
  const std::size_t particles = m.particles.size();
  if (insertion.settings.shapes.empty()) {
    if (insertParticles(insertion, m.particles, around, active) == 0) return;
    rotate();
    admitParticles(m, particles);
  } else {
    BodyTerm& rigid = bodies(m);
    const auto count = static_cast<int>(rigid.bodies.size());
    if (insertParticles(insertion, m.particles, rigid.bodies, rigid.clumps, around, active) == 0) return;
    rotate();
    rigid.admit(m, count);
  }
  m.newcomersTouch = touching;  // as these touch nobody
  const double smallest =
      *std::min_element(m.particles.radius.begin() + static_cast<std::ptrdiff_t>(particles), m.particles.radius.end());
  m.smallestRadius = particles == 0 ? smallest : std::min(m.smallestRadius, smallest);
}

namespace {
template <class Archive, class I>
void archive(Archive& a, I& i) {
  a(i.random, i.nextRadius, i.nextShape, i.due, i.waited, i.inserted, i.refused, i.insertedMass, i.refusedMass);
}
}  // namespace

void InsertionTerm::save(ByteWriter& writer) const {
  archive(writer, insertion);
  writer(replaced_);
}
void InsertionTerm::load(ByteReader& reader) {
  archive(reader, insertion);
  reader(replaced_);
}

void OutletTerm::check(const Model&) const {
  std::visit([](const auto& r) { requireValid(r); }, region);
  if (every < 1)
    throw InputError("it is checked every " + std::to_string(every) + " steps", "outlet", "give 1 or more");
}

/// Nobody has moved by more than the skin from then until the list is made anew, as half of it bounds both moves since
/// the search.
void OutletTerm::lookAround(const Model& m) {
  constexpr double slack = 1.001;  // far above rounding
  const double margin = slack * m.pairs.skin().value_or(0.0);
  near_ = {particlesIn(m.particles, std::visit([&](const auto& r) { return Region(widened(r, margin)); }, region)),
           m.pairs.builds(), m.particles.revision, region};
}

void OutletTerm::exchange(Model& m, const Step& step) {
  if (step.number % every != 0) return;
  const bool lasts = near_.builds == m.pairs.builds() && near_.revision == m.particles.revision &&
                     near_.region == region && !m.pairs.maySearch(m.particles, step.moved);
  if (!lasts) lookAround(m);
  std::vector<int> list;
  std::visit(
      [&](const auto& r) {
        for (const int i : near_.particles)
          if (inside(r, m.particles.x[static_cast<std::size_t>(i)])) list.push_back(i);
      },
      region);
  if (list.empty()) return;
  const Exchanged before = m.left;
  removeParticles(m, list);
  passed.count += m.left.count - before.count;
  passed.mass += m.left.mass - before.mass;
  passed.momentum += m.left.momentum - before.momentum;
  passed.angularMomentum += m.left.angularMomentum - before.angularMomentum;
}

void OutletTerm::save(ByteWriter& writer) const {
  const bool box = std::holds_alternative<geometry::Box>(region);
  writer(box, box ? std::get<geometry::Box>(region) : geometry::Box{}, box ? HalfSpace{} : std::get<HalfSpace>(region),
         every, passed);
}
void OutletTerm::load(ByteReader& reader) {
  bool box = false;
  geometry::Box inBox;
  HalfSpace behind;
  reader(box, inBox, behind, every, passed);
  if (box)
    region = inBox;
  else
    region = behind;
  near_ = {};
}

InsertionTerm& addInsertion(Model& m, const InsertionOptions& settings) {
  if (!settings.shapes.empty()) bodies(m);  // which the insertion would make in the midst of a step
  return m.terms.add(InsertionTerm(settings));
}

OutletTerm& addOutlet(Model& m, const OutletTerm::Region& region) {
  OutletTerm outlet;
  outlet.region = region;
  return m.terms.add(std::move(outlet));
}

}  // namespace dovetail::dem
