#include "dovetail/surface/surface_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/setup/insertion.hpp"

namespace dovetail::surface {

namespace {

/// The largest vᵀ M_lumped v / vᵀ M v: how much lighter nodes are than their lumped masses. By the power method, which
/// tends to it from below; a tenth is added.
double lightness(const coupling::SolidSide& side) {
  if (!side.mass || side.mass->isDiagonal()) return 1.0;
  const std::vector<double>& lumped = side.nodes().mass;
  std::vector<Vec3> x(lumped.size());
  double angle = 0.0;
  for (Vec3& entry : x) entry = {std::cos(angle += 2.4), std::cos(1.3 * angle), std::cos(1.7 * angle)};
  double ratio = 1.0;
  for (int iteration = 0; iteration < 40; ++iteration) {
    double size = 0.0, grown = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) size += lumped[i] * squaredNorm(x[i]);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] *= lumped[i] / std::sqrt(size);
    side.mass->solve(x);
    for (std::size_t i = 0; i < x.size(); ++i) grown += lumped[i] * squaredNorm(x[i]);
    ratio = std::sqrt(grown);
  }
  return 1.1 * std::max(ratio, 1.0);
}

std::vector<double> inverseMasses(const coupling::SolidSide& side) {
  const fem::Nodes& nodes = side.nodes();
  const double factor = lightness(side);
  std::vector<double> inverse(nodes.mass.size(), 0.0);
  for (std::size_t i = 0; i < inverse.size(); ++i)
    if (nodes.fixed[i] != fem::allComponents) inverse[i] = factor / nodes.mass[i];
  return inverse;
}

}  // namespace

SurfaceContact::SurfaceContact(coupling::SolidSide& side, Coupling coupling,
                               std::shared_ptr<const dem::ContactLaws> laws, std::string name)
    : Connector(side), coupling_(std::move(coupling)), laws_(std::move(laws)), name_(std::move(name)) {
  if (!laws_) throw InputError("there are no contact laws", name_, "give makeContactLaws(law)");
  const auto nodes = static_cast<std::size_t>(coupling_.nodeCount());
  if (!side.model || side.nodes().X.size() != nodes)
    throw InputError("its surface belongs to a mesh of " + std::to_string(nodes) + " nodes", name_,
                     "make the skin from the nodes of the solid \"" + side.name + "\"");
  coupling_.check(*laws_);
}

void SurfaceContact::check(const dem::Model& m) const {
  coupling_.check(*laws_, m.pairs.periodicity());
  if (laws_->rotates() && !m.particles.rotates() && m.rotation == dem::Rotation::automatic && m.particles.size() > 0)
    throw InputError("its laws exert torques, but the particles do not spin", name_,
                     "call switchOnRotation(particles), or set Model::rotation to off");
  const int materials = laws_->materials(), own = coupling_.wall().material;
  coupling_.check(m.particles, materials);
  if (materials > 1 && (own < 0 || own >= materials))
    throw InputError("there is no law for material " + std::to_string(own), name_,
                     "give skin.wall.material from 0 to " + std::to_string(materials - 1));
}

void SurfaceContact::surround(dem::Surroundings& around) {
  around.placed.push_back(
      [this]() -> const dem::TriangulatedWall& { return coupling_.outline(side().nodes().u, side().nodes().v); });
}

double SurfaceContact::renumber(std::span<const int> newNumber, const dem::Particles& before) {
  return coupling_.renumber(newNumber, before);
}

void SurfaceContact::addForces(dem::Model& m, const dem::Step& step) {
  const fem::Nodes& nodes = side().nodes();
  m.work += coupling_.exchange(m.particles, nodes.u, nodes.v, *laws_, step.dt,
                               {m.booking, step.timeless, dem::movesOf(m, step), m.pairs.periodicity()});
  const coupling::NodalLoad& load = coupling_.load();
  for (int node : load.touched) side().load.add(node, load.force[static_cast<std::size_t>(node)]);
}

void SurfaceContact::addDemand(const dem::Model& m, dem::ContactDemand& demand) const {
  if (!coupling_.inContact()) return;
  const std::size_t first = demand.links.size();
  coupling_.addDemand(demand, m.particles, *laws_, inverseMasses(side()));
  demand.surfaces.push_back(name_);
  for (std::size_t l = first; l < demand.links.size(); ++l)
    demand.links[l].surface = static_cast<int>(demand.surfaces.size()) - 1;
}

void SurfaceContact::addContacts(const dem::Model& m, dem::ContactSample& sample) const {
  dem::addWallContacts(m.particles, coupling_.wall(), coupling_.contacts(), sample);
}

void SurfaceContact::save(ByteWriter& writer) const { coupling_.save(writer); }
void SurfaceContact::load(ByteReader& reader) { coupling_.load(reader); }

}  // namespace dovetail::surface
