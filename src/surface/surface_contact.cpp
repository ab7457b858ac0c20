#include "dovetail/surface/surface_contact.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/impact.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/setup/insertion.hpp"

namespace dovetail::surface {

namespace {

std::int64_t newId() {
  static std::atomic<std::int64_t> last{0};
  return ++last;
}

}  // namespace

SurfaceContact::SurfaceContact(coupling::SolidSide& side, SurfaceCoupler coupling,
                               std::shared_ptr<const dem::ContactLaws> laws, std::string name)
    : SurfaceContact(side, std::move(laws), std::move(name), std::move(coupling)) {
  const auto nodes = static_cast<std::size_t>(coupling_.nodeCount());
  if (!side.model || side.nodes().X.size() != nodes)
    throw InputError("its surface belongs to a mesh of " + std::to_string(nodes) + " nodes", name_,
                     "make the skin from the nodes of the solid \"" + side.name + "\"");
  coupling_.requireFits(side.nodes().X);
}

SurfaceContact::SurfaceContact(coupling::SolidSide& side, std::shared_ptr<const dem::ContactLaws> laws,
                               std::string name, SurfaceCoupler coupling)
    : Connector(side), coupling_(std::move(coupling)), laws_(std::move(laws)), name_(std::move(name)), id_(newId()) {
  if (!laws_) throw InputError("there are no contact laws", name_, "give makeContactLaws(law)");
  coupling_.check(*laws_);
}

void SurfaceContact::check(const dem::Model& m) const {
  coupling_.check(*laws_, m.pairs.periodicity());
  if (coupling_.onFacets() && hasKernel(coupling_.skin()) && meetsPeriod(coupling_.skin(), m.pairs.periodicity()))
    throw InputError("its surface continues across a periodic boundary, where it cannot have a kernel", name_,
                     "leave the kernel out");
  if (laws_->rotates() && !m.particles.rotates() && m.rotation == dem::Rotation::automatic && m.particles.size() > 0)
    throw InputError("its laws exert torques, but the particles do not spin", name_,
                     "call switchOnRotation(particles), or set Model::rotation to off");
  const int materials = laws_->materials(), own = coupling_.wall().material;
  coupling_.check(m.particles);
  if (materials > 1 && (own < 0 || own >= materials))
    throw InputError("there is no law for material " + std::to_string(own), name_,
                     "give skin.wall.material from 0 to " + std::to_string(materials - 1));
  const std::vector<const SurfaceContact*> parts = partsIn(m);
  if (parts.size() > 1 && parts.front() == this && !surface_) requireJoinable(parts);
  if (coupling_.onFacets()) return;
  for (const auto* other : m.terms.all<SurfaceContact>())
    if (other != this && other->side().model == side().model && other->coupling_.meets(coupling_))
      throw InputError("its smooth surface touches that of \"" + other->name_ + "\" on the same solid", name_,
                       "take facets for both (\"surface\": \"flat\"), or one set of faces");
}

/// Of the solid's surface, those that are facets; or this one alone, if it is not.
std::vector<const SurfaceContact*> SurfaceContact::partsIn(const dem::Model& m) const {
  if (!coupling_.onFacets()) return {this};
  std::vector<const SurfaceContact*> parts;
  for (const auto* one : m.terms.all<SurfaceContact>())
    if (one->side().model == side().model && one->coupling_.onFacets()) parts.push_back(one);
  return parts;
}

void SurfaceContact::requireJoinable(std::span<const SurfaceContact* const> parts) const {
  std::vector<const Skin*> skins;
  for (const SurfaceContact* part : parts) {
    skins.push_back(&part->coupling_.skin());
    if (part->coupling_.options().edges != coupling_.options().edges)
      throw InputError("its contacts are combined by a rule other than that of \"" + part->name_ + "\" on this solid",
                       name_, "give both the same rule for edges (\"edges\")");
  }
  try {
    joined(skins);
  } catch (const InputError& error) {
    throw InputError(error.what(), name_, "");
  }
}

void SurfaceContact::join(dem::Model& m) {
  company_ = {};
  company_.terms = &m.terms;
  company_.revision = m.terms.revision();
  const std::vector<const SurfaceContact*> parts = partsIn(m);
  if (parts.front() != this) return rejoin({});
  std::vector<std::int64_t> ids;
  for (auto* one : m.terms.all<SurfaceContact>())
    if (std::ranges::find(parts, one) != parts.end()) {
      company_.parts.push_back(one);
      ids.push_back(one->id_);
    }
  for (const auto* one : m.terms.all<Connector>()) {
    if (one->side().model != side().model) continue;
    const std::vector<double> fraction = one->solidWeight();
    if (fraction.empty()) continue;
    company_.overlaps.push_back(one);
    if (company_.fraction.empty()) company_.fraction.assign(fraction.size(), 1.0);
    for (std::size_t i = 0; i < fraction.size(); ++i)
      company_.fraction[i] = std::min(company_.fraction[i], fraction[i]);
  }
  rejoin(parts.size() > 1 ? std::move(ids) : std::vector<std::int64_t>{});
  if (surface_ && !state_.empty()) {
    ByteReader reader(std::exchange(state_, {}));
    surface_->load(reader);
  }
}

/// The surface of the parts with these numbers; what was booked on that of others stays.
void SurfaceContact::rejoin(std::vector<std::int64_t> ids) {
  if (ids == surfaceOf_) return;
  if (surface_) booked_ += surface_->madeByWeights();
  surface_.reset();
  if (!ids.empty()) surface_.emplace(surfaceParts());
  surfaceOf_ = std::move(ids);
}

std::vector<SurfacePart> SurfaceContact::surfaceParts() const {
  std::vector<SurfacePart> parts;
  for (SurfaceContact* part : company_.parts) parts.push_back({&part->coupling_, part->laws_.get()});
  return parts;
}

double SurfaceContact::lost() const {
  return -coupling_.madeByTransfer() - coupling_.madeByWeights() - booked_ -
         (surface_ ? surface_->madeByWeights() : 0.0);
}

void SurfaceContact::surround(dem::Surroundings& around) {
  around.placed.push_back([this]() -> const dem::TriangulatedWall& {
    const Motion nodes = carrying();
    return coupling_.outline(nodes.u, nodes.v);
  });
}

double SurfaceContact::renumber(std::span<const int> newNumber, const dem::Particles&) {
  if (surface_) surface_->renumber(newNumber);
  return coupling_.renumber(newNumber);
}

ExchangeOptions SurfaceContact::exchangeOptions(const dem::Model& m, const dem::Step& step) const {
  return {m.booking, dem::movesOf(m, step), m.pairs.periodicity(), company_.fraction, tied_};
}

/// Errors of contacts say with whom, and when.
template <class Call>
void SurfaceContact::naming(const dem::Step& step, Call&& call) const {
  try {
    call();
  } catch (const NumericalError& error) {
    throw NumericalError(error.what(),
                         name_ + ", t = " + formatNumber(step.time) + " s, step " + std::to_string(step.number), "");
  }
}

void SurfaceContact::findFacetContacts(dem::Model& m, const dem::Step& step, std::vector<dem::WallAtSeam>& seams) {
  if (company_.terms != &m.terms || company_.revision != m.terms.revision()) join(m);
  if (company_.parts.empty()) return;
  tied_.assign(company_.overlaps.empty() ? 0 : m.particles.size(), 0);
  for (const coupling::Connector* overlap : company_.overlaps) overlap->markTied(tied_);
  const Motion nodes = carrying();
  const ExchangeOptions options = exchangeOptions(m, step);
  naming(step, [&] {
    if (surface_) {
      surface_->find(surfaceParts(), m.particles, nodes.u, nodes.v, options);
      surface_->addSeam(surfaceParts(), options, seams);
    } else {
      coupling_.find(m.particles, nodes.u, nodes.v, laws_->reach(), options);
      coupling_.addSeam(answered(), options, seams);
    }
  });
}

void SurfaceContact::takeFacetContacts(dem::Model& m, const dem::Step& step,
                                       std::vector<dem::AnsweredContacts>& walls) {
  if (company_.parts.empty()) return;
  const Motion nodes = carrying();
  const ExchangeOptions options = exchangeOptions(m, step);
  if (surface_)
    surface_->handOut(surfaceParts(), m.particles, nodes.u, nodes.v, options);
  else
    coupling_.weigh(m.particles, options);
  for (SurfaceContact* part : company_.parts) part->coupling_.addAnswered(part->answered(), walls);
}

void SurfaceContact::addForces(dem::Model& m, const dem::Step& step) {
  if (company_.parts.empty()) return;
  const Motion nodes = carrying();
  const ExchangeOptions options = exchangeOptions(m, step);
  naming(step, [&] {
    if (surface_) {
      m.work += surface_->answer(surfaceParts(), m.particles, nodes.u, step.dt, options);
    } else {
      m.work += coupling_.answer(m.particles, nodes.u, *laws_, step.dt, options);
      coupling_.bookWeights(options);
    }
  });
  for (SurfaceContact* part : company_.parts) part->loadSide();
}

Momenta SurfaceContact::onSolid(const Vec3& about) const {
  const fem::Nodes& nodes = side().nodes();
  const coupling::NodalLoad& load = coupling_.load();
  Momenta sum;
  for (const int node : load.touched) {
    const auto n = static_cast<std::size_t>(node);
    sum.add(nodes.X[n] + nodes.u[n] - about, load.force[n]);
  }
  return sum;
}

void SurfaceContact::loadSide() {
  const coupling::NodalLoad& load = coupling_.load();
  for (int node : load.touched) side().load.add(node, load.force[static_cast<std::size_t>(node)]);
}

void SurfaceContact::addDemand(const dem::Model& m, dem::ContactDemand& demand) const {
  if (!coupling_.inContact()) return;
  const std::size_t first = demand.links.size();
  coupling_.addDemand(demand, m.particles, *laws_, side().addTo(demand));
  demand.surfaces.push_back(name_);
  for (std::size_t l = first; l < demand.links.size(); ++l)
    demand.links[l].surface = static_cast<int>(demand.surfaces.size()) - 1;
}

void SurfaceContact::addPartners(const dem::Model&, std::vector<dem::ImpactPartner>& partners) const {
  const fem::Nodes& nodes = side().nodes();
  geometry::Box box{nodes.X.front(), nodes.X.front()};
  for (const Vec3& X : nodes.X)
    for (int c = 0; c < 3; ++c)
      box.lower[c] = std::min(box.lower[c], X[c]), box.upper[c] = std::max(box.upper[c], X[c]);
  double speed = 0.0;
  for (const Vec3& v : nodes.v) speed = std::max(speed, norm(v));
  partners.push_back({.name = '"' + name_ + '"',
                      .laws = laws_.get(),
                      .material = coupling_.wall().material,
                      .inverseMass = coupling_.largestMobility(
                          ofCarrying(side().inverseMasses(coupling::SolidSide::Forces::atOnePlace))),
                      .speed = speed,
                      .box = box,
                      .of = side().model,
                      .inMacroSteps = side().stepping == coupling::Stepping::implicitSteps});
}

void SurfaceContact::addContacts(const dem::Model& m, dem::ContactSample& sample) const {
  dem::addWallContacts(m.particles, coupling_.wall(), coupling_.contacts(), sample);
}

void SurfaceContact::save(ByteWriter& writer) const {
  coupling_.save(writer);
  ByteWriter whole;
  if (surface_) surface_->save(whole);
  writer(booked_, surface_ ? whole.bytes() : state_);
}
void SurfaceContact::load(ByteReader& reader) {
  coupling_.load(reader);
  reader(booked_, state_);
  if (!surface_ || state_.empty()) return;
  ByteReader whole(std::exchange(state_, {}));
  surface_->load(whole);
}

}  // namespace dovetail::surface
