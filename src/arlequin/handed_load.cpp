#include "dovetail/arlequin/handed_load.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "dovetail/arlequin/overlap_tie.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::arlequin {

namespace {

/// Dead forces of each node.
class NodeForces final : public fem::Term {
public:
  std::string name() const override { return "load of the particles"; }
  void addForces(const fem::Nodes&, const fem::Instant&, std::span<Vec3> f) override {
    for (std::size_t n = 0; n < force.size(); ++n) f[n] += force[n];
  }
  std::vector<Vec3> force;  // N
};

double largest(std::span<const Vec3> values) {
  double most = 0.0;
  for (const Vec3& v : values) most = std::max(most, norm(v));
  return most;
}

double largestChange(std::span<const Vec3> a, std::span<const Vec3> b) {
  double most = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) most = std::max(most, norm(a[n] - b[n]));
  return most;
}

/// Who hands over, round by round. A particle that has left the overlap, or is at another image of itself in periodic
/// space, is struck off: to and fro it would change the load for ever.
struct Givers {
  explicit Givers(std::size_t particles) : gives(particles, 1), at(particles) {}
  std::vector<char> gives;
  std::vector<std::optional<Vec3>> at;  // where the mesh has the particle, m; none before it is in the overlap

  /// Those that gave before and were not found this time.
  void strikeOffAllBut(const std::vector<char>& found) {
    for (std::size_t i = 0; i < gives.size(); ++i)
      if (at[i] && !found[i]) gives[i] = 0;
  }
};

/// As handedLoad, of those that still give.
std::vector<Vec3> loadOf(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
                         std::span<const double> nodalWeight, double leastShare, Givers& givers) {
  constexpr double anyPenalty = 1.0;  // a tie that was just made has no gap
  dem::Model weighed = grains;
  dem::removeParticles(weighed, particlesBeyond(weighed, mesh, solid.nodes, nodalWeight, leastShare));
  coupling::SolidSide side;
  side.name = "solid";
  side.model = &solid;
  side.load = coupling::NodalLoad(solid.nodes.X.size());
  CouplingOptions options;
  options.penalty = anyPenalty;
  options.leastShare = leastShare;
  auto made = makeOverlapTie(weighed, mesh, {nodalWeight.begin(), nodalWeight.end()}, side, options);
  const OverlapTie& tie = *made;
  weighed.terms.add(std::unique_ptr<dem::Term>(std::move(made)));
  dem::findForces(weighed);
  std::vector<Vec3> load(solid.nodes.X.size());
  std::vector<char> found(givers.gives.size(), 0);
  for (std::size_t k = 0; k < tie.overlap().size(); ++k) {
    const auto j = static_cast<std::size_t>(tie.overlap().particle[k]);
    const auto i = static_cast<std::size_t>(dem::find(grains.particles, weighed.particles.id[j]));
    if (!givers.gives[i]) continue;
    const fem::CellPlace& place = tie.overlap().place[k];
    const Cell cell = cellOf(mesh, place.element);
    Vec3 at;
    for (std::size_t a = 0; a < cell.node.size(); ++a) {
      const auto n = static_cast<std::size_t>(cell.node[a]);
      at += place.shape[a] * (solid.nodes.X[n] + solid.nodes.u[n]);
    }
    if (givers.at[i] && norm(at - *givers.at[i]) > grains.particles.radius[i]) continue;
    givers.at[i] = at;
    found[i] = 1;
    for (std::size_t a = 0; a < cell.node.size(); ++a)
      load[static_cast<std::size_t>(cell.node[a])] += place.shape[a] * weighed.particles.f[j];
  }
  givers.strikeOffAllBut(found);
  return load;
}

}  // namespace

std::vector<Vec3> handedLoad(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
                             std::span<const double> nodalWeight, double leastShare) {
  Givers all(grains.particles.size());
  return loadOf(grains, mesh, solid, nodalWeight, leastShare, all);
}

int takeOver(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
             std::span<const double> nodalWeight, const TakeOverOptions& options) {
  requirePositive(options.tolerance, "tolerance of the handed load");
  if (options.rounds < 1)
    throw InputError("rounds is " + std::to_string(options.rounds), "TakeOverOptions", "give 1 or more");
  for (const auto& term : grains.terms)
    if (const auto* tie = dynamic_cast<const OverlapTie*>(term.get()); tie && tie->side().model == &solid)
      throw InputError("the particles are tied to this solid already", "initial stress",
                       "take over first and make the tie after that");
  if (std::ranges::all_of(solid.nodes.mass, [](double mass) { return mass == 0.0; })) fem::addMass(solid);
  const double time = solid.t;
  const auto load = std::make_shared<NodeForces>();
  Givers givers(grains.particles.size());
  load->force = loadOf(grains, mesh, solid, nodalWeight, options.leastShare, givers);
  solid.terms.push_back(load);
  int round = 1;
  for (bool settled = false; !settled; ++round) {
    try {
      fem::solveStatics(solid, solid.t + 1.0, options.statics);
    } catch (...) {
      solid.terms.pop_back();
      solid.t = time;
      throw;
    }
    std::vector<Vec3> next = loadOf(grains, mesh, solid, nodalWeight, options.leastShare, givers);
    settled = largestChange(next, load->force) <= options.tolerance * largest(next);
    load->force = std::move(next);
    if (settled || round < options.rounds) continue;
    solid.terms.pop_back();
    solid.t = time;
    throw NumericalError("the load that particles hand over still changes after " + std::to_string(round) + " rounds",
                         "initial stress", "take a stiffer solid or a thicker overlap");
  }
  solid.terms.pop_back();
  solid.t = time;
  return round - 1;
}

}  // namespace dovetail::arlequin
