#include "called_laws.hpp"

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace {

/// Of this thread: used again unless arrays of an earlier step are still looked at.
std::shared_ptr<Batch> room() {
  static thread_local std::shared_ptr<Batch> last;
  if (!last || last.use_count() > 1) last = std::make_shared<Batch>();
  return last;
}

/// Particles are known while the law is asked, whatever becomes of that.
class ForAWhile {
public:
  explicit ForAWhile(ContactsView& contacts) : contacts_(contacts) {}
  ~ForAWhile() { contacts_.particles = nullptr; }
  ForAWhile(const ForAWhile&) = delete;
  ForAWhile& operator=(const ForAWhile&) = delete;

private:
  ContactsView& contacts_;
};

/// Notes the contacts that the loops of the library come by, and then gives what has been found for them.
struct Tape {
  std::vector<dem::Contact> contacts;
  std::vector<dem::ContactSlopes> slopes;
  std::size_t next = 0;
};
struct TapedLaw {
  static constexpr int memory = 0;
  static constexpr int recalled(dem::Recall) { return 0; }
  struct Touch {
    double range;
    double reach() const { return range; }
  };
  struct Prepared {
    Touch normal;
    Tape* tape;
    double reach() const { return normal.range; }
    bool usesMass() const { return true; }
    dem::Recall recall() const { return dem::Recall::nothing; }
    dem::ContactSlopes slopes(const dem::Contact& contact, double*) const {
      if (!tape->slopes.empty()) return tape->slopes[tape->next++];
      tape->contacts.push_back(contact);
      return {{1.0, 0.0}, {}, {}};
    }
  };
};

void fill(const Tape& tape, const LawTraits& law, Batch& batch) {
  batch.start(tape.contacts.size(), Batch::memory + static_cast<std::size_t>(law.kept()), 1.0);
  std::ranges::fill(batch.given, 0.0);
  std::ranges::fill(batch.first, -1);
  std::ranges::fill(batch.second, -1);
  for (std::size_t k = 0; k < batch.count; ++k) {
    const dem::Contact& contact = tape.contacts[k];
    const auto put = [&](std::size_t c, double value) { batch.givenColumn(c)[k] = value; };
    put(Batch::overlap, contact.overlap);
    put(Batch::overlapBefore, contact.overlap);
    put(Batch::mass, contact.effectiveMass);
    put(Batch::engagement, 1.0);
    put(Batch::engagementUntilEnd, 1.0);
    put(Batch::radius, contact.effectiveRadius);
    for (int d = 0; d < 3; ++d) put(Batch::normal + static_cast<std::size_t>(d), contact.normal[d]);
  }
}

}  // namespace

CalledLaws::CalledLaws(std::string name, LawTraits law, py::function function, py::function stiffness,
                       std::map<std::string, double> parameters)
    : name_("own law " + std::move(name)),
      law_(std::move(law)),
      function_(python::held(std::move(function))),
      stiffness_(python::held(std::move(stiffness))),
      parameters_(std::move(parameters)) {
  if (law_.memory < 0 || law_.memory > LawTraits::mostMemory)
    throw InputError("memory is " + std::to_string(law_.memory), name_,
                     "give 0 to " + std::to_string(LawTraits::mostMemory) + " numbers");
  for (const int c : law_.vectors)
    if (c < 0 || c + 3 > law_.memory)
      throw InputError("a tangential vector begins at number " + std::to_string(c) + " of the memory", name_,
                       "give the first of three of its " + std::to_string(law_.memory) + " numbers");
  if (!(law_.reach >= 0.0) || !std::isfinite(law_.reach))
    throw InputError("reach is not finite and >= 0", name_, "give m beyond touch");
}

void CalledLaws::answer(const std::shared_ptr<Batch>& batch, const dem::Particles& particles) const {
  const py::gil_scoped_acquire lock;
  const py::object view = py::cast(ContactsView{batch, law_.memory, &particles});
  auto& contacts = py::cast<ContactsView&>(view);
  const ForAWhile known(contacts);
  if (!takeAnswers((*function_)(view), contacts, name_)) lacksEnergies_ = true;
}

dem::ContactWork CalledLaws::pairs(dem::Particles& particles, dem::PairList& list, double dt,
                                   dem::Booking booking) const {
  const std::shared_ptr<Batch> batch = room();
  return answerPairs(law_, particles, list, dt, booking, *batch, [&](Batch&) { answer(batch, particles); });
}

dem::ContactWork CalledLaws::wall(dem::Particles& particles, dem::PrimitiveWall& wall, double dt,
                                  dem::Booking booking) const {
  dem::detail::requireStep(dt);
  dem::PrimitiveContacts& contacts = wall.contacts;
  const std::shared_ptr<Batch> batch = room();
  contacts.force.resize(contacts.size());
  if (law_.rotates) contacts.couple.resize(contacts.size());
  const double ended =
      powerOf(law_, dem::detail::carryMemory(particles, contacts, law_.numbers(), law_.wallMemoryKind()), dt);
  const bool spins = law_.rotates && particles.rotates();
  dem::ContactWork work = answerWall(law_, particles, contacts, contacts.memory, {.material = wall.material}, dt,
                                     booking, dem::detail::AgainstPrimitive{particles, wall, spins}, *batch,
                                     [&](Batch&) { answer(batch, particles); });
  if (booking == dem::Booking::on) work.frictionPower += ended;
  dem::detail::addToParticles(particles, wall, spins);
  return work;
}

dem::ContactWork CalledLaws::wall(dem::Particles& particles, const dem::TriangulatedWall& wall,
                                  dem::WallContacts& contacts, double dt, dem::Booking booking) const {
  dem::detail::requireStep(dt);
  const std::shared_ptr<Batch> batch = room();
  const double ended =
      powerOf(law_, dem::detail::carrySprings(particles, contacts, law_.numbers(), law_.wallMemoryKind()), dt);
  if (law_.rotates) contacts.couple.assign(contacts.size(), Vec3{});
  const bool spins = law_.rotates && particles.rotates();
  dem::ContactWork work = answerWall(law_, particles, contacts, contacts.springs.next, {wall.material, wall.mass}, dt,
                                     booking, dem::detail::AgainstFacets{particles, wall, contacts, spins}, *batch,
                                     [&](Batch&) { answer(batch, particles); });
  if (booking == dem::Booking::on) work.frictionPower += ended;
  dem::detail::addToParticles(particles, wall, contacts, spins);
  dem::detail::keepSprings(contacts);
  return work;
}

template <class AddDemand>
void CalledLaws::demandOf(const AddDemand& add, dem::ContactDemand& demand) const {
  Tape tape;
  const dem::PreparedLaws<TapedLaw> laws{1, {{{law_.reach}, &tape}}};
  dem::ContactDemand unused;
  add(unused, laws);
  if (tape.contacts.empty()) return;
  const std::shared_ptr<Batch> batch = room();
  fill(tape, law_, *batch);
  {
    const py::gil_scoped_acquire lock;
    const auto answers = py::cast<py::tuple>((*stiffness_)(py::cast(ContactsView{batch, law_.memory, nullptr})));
    std::array<Numbers, 3> values;
    for (std::size_t a = 0; a < 3; ++a) values[a] = py::cast<Numbers>(answers[a]);
    for (std::size_t k = 0; k < batch->count; ++k) {
      const auto of = [&](std::size_t a) { return values[a].at(static_cast<py::ssize_t>(k)); };
      for (std::size_t a = 0; a < 3; ++a)
        if (!std::isfinite(of(a)) || of(a) < 0.0 || (a == 0 && of(a) == 0.0))
          throw InputError(std::string(a == 2 ? "the damping" : "the stiffness") + " of a contact is not finite and " +
                               (a == 0 ? "> 0" : ">= 0"),
                           name_, "limits of the step follow from it: give N/m");
      const double twice = law_.damps ? 2.0 : 1.0;  // as of the library's laws: ContactLaw's slopes
      tape.slopes.push_back({{of(0), twice * of(2)}, {of(1), 0.0}, {}});
    }
  }
  add(demand, laws);
}

void CalledLaws::addDemand(dem::ContactDemand& demand, const dem::Particles& particles, const dem::PairList& list,
                           double leastOverlap) const {
  const auto add = [&](dem::ContactDemand& to, const auto& laws) {
    dem::detail::addPairDemand(to, particles, list, laws, leastOverlap);
  };
  demandOf(add, demand);
}
void CalledLaws::addDemand(dem::ContactDemand& demand, const dem::Particles& particles,
                           const dem::PrimitiveWall& wall) const {
  const auto add = [&](dem::ContactDemand& to, const auto& laws) {
    dem::detail::addWallDemand(to, particles, wall.contacts, laws, wall.material);
  };
  demandOf(add, demand);
}
void CalledLaws::addDemand(dem::ContactDemand& demand, const dem::Particles& particles,
                           const dem::TriangulatedWall& wall, const dem::WallContacts& contacts) const {
  const auto add = [&](dem::ContactDemand& to, const auto& laws) {
    dem::detail::addWallDemand(to, particles, contacts, laws, wall.material, wall.mass);
  };
  demandOf(add, demand);
}

dem::ContactSample CalledLaws::sample(const dem::Particles& particles, const dem::PairList& list) const {
  constexpr double noTime = 1e-100;  // so short a step that no memory advances
  dem::detail::requireMemory(list, law_.kept());
  dem::ContactSample all;
  if (list.size() == 0) return all;
  dem::detail::PairsApart apart(list.size());
  apart.take(particles, list, 0, law_.kept());
  for (std::size_t k = 0; k < list.size(); ++k)
    for (std::size_t side = 0; side < 2; ++side)
      apart.particles.id[2 * k + side] = particles.id[static_cast<std::size_t>(list.pairs()[k][side])];
  pairs(apart.particles, apart.list, noTime, dem::Booking::off);
  dem::detail::appendPairs(apart, list, 0, all);
  return all;
}

void CalledLaws::saveParameters(ByteWriter& writer) const {
  writer(law_.memory, law_.vectors, law_.rotates, law_.reach);
  for (const auto& [name, value] : parameters_) writer(name, value);
}

}  // namespace dovetail::python
