#include "carried_walls.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "rotational_mobility.hpp"

namespace dovetail::dem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr const char* remedy = "give it a body of its own: addFreeWall(model, wall, density)";

/// visit(mesh, body) for every wall on a body.
template <class Model, class Visit>
void forEachCarried(Model& m, Visit&& visit) {
  for (auto* term : m.terms.template all<MeshWallTerm>())
    if (auto* carrier = std::get_if<WallOnBody>(&term->mesh.motion)) visit(term->mesh, *carrier);
}

/// Bound on 1/(effective mass) that a force at a contact meets, 1/kg. Rolling resistance counts over 2/5 of the
/// squared radius of the particle.
double yielding(const Bodies& bodies, std::size_t b, const Particles& particles, int particle, const Vec3& arm) {
  const Vec3& inertia = bodies.inertia[b];
  const double translation = 1.0 / bodies.mass[b] + rotationalMobility(rotateBack(bodies.orientation[b], arm), inertia);
  if (!particles.rotates()) return translation;
  const double radius = particles.radius[at(particle)];
  return translation + radius * radius / (2.5 * std::min({inertia.x, inertia.y, inertia.z}));
}

}  // namespace

const Bodies& bodiesOf(const Model& m) {
  const auto terms = m.terms.all<BodyTerm>();
  if (terms.empty()) throw InputError("it is on a body, but the model has none", "triangulated wall", remedy);
  return terms.front()->bodies;
}

void checkCarrier(const Model& m, const WallOnBody& carrier, std::size_t vertices) {
  const Bodies& bodies = bodiesOf(m);
  const auto terms = m.terms.all<BodyTerm>();
  const std::string name = "body " + std::to_string(carrier.body);
  const auto refuse = [](const std::string& problem) { throw InputError(problem, "triangulated wall", remedy); };
  if (terms.size() > 1)
    throw InputError("the model has more than one term of bodies", "triangulated wall on a body",
                     "add all bodies to bodies(model)");
  if (carrier.body < 0 || at(carrier.body) >= bodies.size()) refuse("there is no " + name + ", which it is on");
  if (carrier.offset.size() != vertices)
    refuse("there are " + std::to_string(carrier.offset.size()) + " offsets for its " + std::to_string(vertices) +
           " vertices");
  const std::vector<int>& withMembers = terms.front()->clumps.body;
  if (std::find(withMembers.begin(), withMembers.end(), carrier.body) != withMembers.end())
    refuse(name + ", which it is on, is a clump");
}

void placeCarriedWalls(Model& m, const Bodies& bodies, double time) {
  forEachCarried(m, [&](MeshWall& mesh, const WallOnBody&) { moveWall(mesh, time, 0.0, &bodies); });
}

void gatherCarriedWalls(Model& m, Bodies& bodies) {
  forEachCarried(m, [&](const MeshWall& mesh, const WallOnBody& carrier) { gatherForces(mesh.wall, carrier, bodies); });
}

void shiftCarriedWalls(Model& m, const Bodies& bodies, std::span<const Vec3> before) {
  forEachCarried(m, [&](MeshWall& mesh, const WallOnBody& carrier) {
    const Vec3 way = bodies.x[at(carrier.body)] - before[at(carrier.body)];
    if (way == Vec3{}) return;
    for (Vec3& x : mesh.wall.x) x += way;
    mesh.candidates.builds = 0;
  });
}

void renumberCarriedWalls(Model& m, std::span<const char> gone) {
  forEachCarried(m, [&](MeshWall&, WallOnBody& carrier) {
    carrier.body -=
        static_cast<int>(std::count_if(gone.begin(), gone.begin() + carrier.body, [](char g) { return g != 0; }));
  });
}

void addCarriedDemand(const Model& m, const Bodies& bodies, ContactDemand& demand) {
  if (!m.laws) return;
  forEachCarried(m, [&](const MeshWall& mesh, const WallOnBody& carrier) {
    const std::size_t first = demand.links.size();
    m.laws->addDemand(demand, m.particles, mesh.wall, mesh.contacts);
    double most = 0.0;
    for (std::size_t c = 0; c < mesh.contacts.size(); ++c)
      most = std::max(most, yielding(bodies, at(carrier.body), m.particles, mesh.contacts.particle[c],
                                     contactPoint(mesh.contacts, mesh.wall, c) - bodies.x[at(carrier.body)]));
    for (std::size_t k = first; k < demand.links.size(); ++k) {
      ContactDemand::Link& link = demand.links[k];
      link.shifting = std::max(link.shifting, 2.5 * link.turning);
      link.shiftingDamping = std::max(link.shiftingDamping, 2.5 * link.turningDamping);
    }
    demand.standOn(first, &bodies.mass[at(carrier.body)], most);
  });
}

std::vector<double> wallExtents(const Model& m, const Bodies& bodies) {
  std::vector<double> extent(bodies.size(), 0.0);
  forEachCarried(m, [&](const MeshWall&, const WallOnBody& carrier) {
    for (const Vec3& arm : carrier.offset) extent[at(carrier.body)] = std::max(extent[at(carrier.body)], norm(arm));
  });
  return extent;
}

void markTouched(const Model& m, std::vector<char>& bodies) {
  forEachCarried(m, [&](const MeshWall& mesh, const WallOnBody& carrier) {
    if (mesh.contacts.size() > 0) bodies[at(carrier.body)] = 1;
  });
}

}  // namespace dovetail::dem
