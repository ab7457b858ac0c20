#include "dovetail/arlequin/initial_equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "dovetail/arlequin/arlequin_coupling.hpp"
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

/// As initialLoad, of those that still give.
std::vector<Vec3> loadOf(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
                         std::span<const double> nodalWeight, double leastWeight, Givers& givers) {
  constexpr double anyPenalty = 1.0;  // a tie that was just made has no gap
  dem::Model weighed = grains;
  dem::removeParticles(weighed, particlesBeyond(weighed, mesh, solid.nodes, nodalWeight, leastWeight));
  coupling::SolidSide side;
  side.name = "solid";
  side.model = &solid;
  side.load = coupling::NodalLoad(solid.nodes.X.size());
  CouplingOptions options;
  options.penalty = anyPenalty;
  options.leastWeight = leastWeight;
  auto made = makeArlequinCoupling(weighed, mesh, {nodalWeight.begin(), nodalWeight.end()}, side, options);
  const ArlequinCoupling& tie = *made;
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

/// To the equilibrium under the load at the solid's time: in one step, or in several in which what is out of balance is
/// let go of part by part.
void balance(fem::Model& solid, NodeForces& load, const fem::StaticOptions& statics) {
  const std::vector<Vec3> goal = load.force;
  fem::evaluateForces(solid, {solid.t, 0.0});
  const std::vector<Vec3> left = solid.nodes.f;  // out of balance at the start, N
  double done = 0.0, part = 1.0;
  while (done < 1.0) {
    const double next = std::min(1.0, done + part);
    for (std::size_t n = 0; n < goal.size(); ++n) load.force[n] = goal[n] - (1.0 - next) * left[n];
    try {
      fem::solveStatics(solid, solid.t, statics);
    } catch (const NumericalError&) {
      part *= 0.4;
      if (part < statics.smallestStep) throw;
      continue;
    }
    done = next;
    part *= 2.0;
  }
}

}  // namespace

std::vector<Vec3> initialLoad(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
                              std::span<const double> nodalWeight, double leastWeight) {
  Givers all(grains.particles.size());
  return loadOf(grains, mesh, solid, nodalWeight, leastWeight, all);
}

namespace {

/// What a solid carries for as long as this lives.
class Hold {
public:
  explicit Hold(fem::Model& solid) : solid_(solid) { solid.terms.push_back(load_); }
  ~Hold() { solid_.terms.pop_back(); }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

  std::vector<Vec3>& force() { return load_->force; }
  void balance(const fem::StaticOptions& statics) { arlequin::balance(solid_, *load_, statics); }
  /// Goes on towards the load that is handed over now. A contact whose weight jumps where the solid is (a particle
  /// passes a face of an element) changes it to and fro: steps that turn back are halved, and the solid comes to stand
  /// where it jumps. @return whether that is done, or nothing changes; change: over the largest of the load
  bool follow(const std::vector<Vec3>& next, double tolerance, double& change) {
    double along = 0.0;
    before_.resize(next.size());
    for (std::size_t n = 0; n < next.size(); ++n) {
      const Vec3 difference = next[n] - load_->force[n];
      along += dot(difference, before_[n]);
      before_[n] = difference;
    }
    step_ = along < 0.0 ? 0.5 * step_ : std::min(1.0, 1.2 * step_);
    const double all = largest(next), most = largest(before_);
    change = all > 0.0 ? most / all : 0.0;
    if (change <= tolerance || (along < 0.0 && step_ * change <= tolerance)) return true;
    for (std::size_t n = 0; n < next.size(); ++n) load_->force[n] += step_ * before_[n];
    return false;
  }

private:
  fem::Model& solid_;
  std::shared_ptr<NodeForces> load_ = std::make_shared<NodeForces>();
  std::vector<Vec3> before_;  // the change before, N
  double step_ = 1.0;         // of the change that is gone
};

}  // namespace

int initialEquilibrium(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
                       std::span<const double> nodalWeight, const InitialEquilibriumOptions& options, double* change) {
  requirePositive(options.tolerance, "tolerance of the load");
  if (options.rounds < 1)
    throw InputError("rounds is " + std::to_string(options.rounds), "InitialEquilibriumOptions", "give 1 or more");
  for (const auto& term : grains.terms)
    if (const auto* tie = dynamic_cast<const ArlequinCoupling*>(term.get()); tie && tie->side().model == &solid)
      throw InputError("the particles are coupled to this solid already", "initial stress",
                       "call initialEquilibrium first and add the coupling after that");
  if (std::ranges::all_of(solid.nodes.mass, [](double mass) { return mass == 0.0; })) fem::addMass(solid);
  Givers givers(grains.particles.size());
  const auto handed = [&] { return loadOf(grains, mesh, solid, nodalWeight, options.leastWeight, givers); };
  std::vector<Vec3> first = handed();
  Hold hold(solid);
  hold.force() = std::move(first);
  for (int round = 1;; ++round) {
    hold.balance(options.statics);
    double left = 0.0;
    const bool settled = hold.follow(handed(), options.tolerance, left);
    if (change) *change = left;
    if (settled) return round;
    if (round == options.rounds)
      throw NumericalError("after " + std::to_string(round) + " rounds the load of the particles still changes by " +
                               formatNumber(left) + " of the largest nodal load",
                           "initial stress",
                           "allow more rounds if that falls; if it grows, the solid is too soft for the load: take a "
                           "stiffer one, or a thicker overlap");
  }
}

}  // namespace dovetail::arlequin
