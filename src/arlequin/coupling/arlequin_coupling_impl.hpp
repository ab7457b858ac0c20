// The state of an overlap tie.
#pragma once

#include <optional>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "overlap/overlap_locator.hpp"
#include "pair_weights.hpp"
#include "tie_parts.hpp"

namespace dovetail::arlequin {

/// What a copy takes along and files hold.
struct TieState {
  TieSetting setting;
  Overlap overlap;            // x: the material points at which particles are tied, m
  std::vector<int> memberOf;  // row of each particle in the overlap, −1: none
  std::int64_t known = -1;    // Particles::revision of the numbers
  std::int64_t knownIds = 0;  // Particles::nextId when newcomers were last looked for
  PairWeights weights;
  bool refit = false;  // somebody has taken members out: rows keep their gap all the same

  std::vector<Vec3> kept;            // per row: part of the gap that is not of the present ties, m
  std::vector<Vec3> now, increment;  // the gap, and of the last step, m
  std::vector<Vec3> atMacroStep;     // the gap at the last end of a macro step, m, of ties that act there
  std::vector<Vec3> macroIncrement;  // of the macro step that ended there, m
  std::optional<double> macroTime;   // of that end, s
  double openingWork = 0.0;          // that the first half macro step's kick from there on takes, J
  std::vector<Vec3> lambda;          // N
  std::vector<int> rowNode;          // to which the arrays above belong
  std::vector<Vec3> nodesBefore;     // u at the last evaluation, m

  bool advanced = false;  // the gap has been brought up to this step, and half of its work is booked

  double storedNow = 0.0, lost = 0.0;            // J
  double absorbed = 0.0, power = 0.0;            // J, W
  bool complies = false;                         // velocities have been made to comply with the multipliers
  double memberTravel = 0.0;                     // bound on relative moves of members over their slip lengths
  double farTravel = 0.0;                        // bound on moves of all others, m
  double meanRadius = 0.0, largestRadius = 0.0;  // m, of the members when the tie was made, the mean by mass
  std::vector<int> near;                         // particles outside that may come in, by number
  std::vector<std::int64_t> strangers;           // ids of OverlapState::strangers, ascending
  OverlapState events;
};

/// Members as they will be.
struct OverlapUpdate {
  struct Change {
    int particle;
    double before, after;  // weights
    fem::CellPlace place;  // whose nodes share the momentum
  };
  Overlap next;
  std::vector<Change> changes;
  std::vector<char> isMoved;  // one per particle
  std::vector<int> beyond;    // particles that have passed their border

  OverlapUpdate(const std::vector<double>& nodalWeight, std::size_t particles) : isMoved(particles, 0) {
    next.nodalWeight = nodalWeight;
  }
  void tie(int particle, const FoundParticle& found, const Vec3& material) {
    addMember(next, particle, found.place, material, found.weight);
  }
};

struct ArlequinCoupling::Impl : TieState {
  coupling::SolidSide& side;
  bool loadsNobody = false;  // it belongs to a copy of the particles' model
  TieParts parts;
  bool stale = true;                       // the parts are not those of the overlap
  const fem::ModelMass* massOf = nullptr;  // that the parts were made with: every start of a run makes another

  explicit Impl(coupling::SolidSide& s) : side(s) {}
  Impl(const TieState& state, coupling::SolidSide& s) : TieState(state), side(s), loadsNobody(true) {}

  const fem::Nodes& nodes() const { return side.nodes(); }
  std::vector<Vec3> positions() const { return positionsOf(nodes().X, nodes().u); }
  bool isFollowed() const { return !setting.options.projection.perElement; }
  bool turnsGap() const {
    return setting.options.constraint == ConstraintKind::penalty && setting.options.form == GapForm::atParticles;
  }
  /// On implicit solids multipliers and dashpots act at the ends of macro steps, whose increments and rates they see.
  bool actsInMacroSteps() const {
    return setting.options.constraint != ConstraintKind::penalty && side.stepping == coupling::Stepping::implicitSteps;
  }
  bool needsMass() const { return setting.options.constraint == ConstraintKind::multiplier; }
  double slipLength(const dem::Model& m, std::size_t k) const {
    return slipLengthOf(m.particles.radius[static_cast<std::size_t>(overlap.particle[k])]);
  }

  /// Rows of wide kernels hang together: what one of them keeps, or slips by, alone is a wave that the metric of the
  /// others answers with forces without bounds. There members slip one by one, and the gap follows.
  bool hasWideRows() const { return turnsGap() && setting.options.projection.width > 0.0; }
  /// The gap that a penalty answers with these forces, m.
  std::vector<Vec3> gapUnder(std::span<const Vec3> forces) const;
  /// D Πᵀλ, m: of the members on springs of their own, one by one.
  std::vector<Vec3> motionUnder(std::span<const Vec3> forces) const;

  double springOf(const dem::Model& m, std::size_t k) const;
  /// Levels what springs of members ask of the step, as far as the tie lets it.
  void level(const dem::Model& m, const dem::ContactDemand& demand,
             const std::vector<dem::ContactDemand::Range>& nodesOf, std::vector<double>& springs) const;
  /// Solid's field of the nodes at a place, and at a member.
  Vec3 atPlace(const fem::CellPlace& place, std::span<const Vec3> field) const;
  Vec3 atMember(std::size_t k, std::span<const Vec3> field) const { return atPlace(overlap.place[k], field); }
  /// Displacement of a member from its material point, images left out.
  Vec3 displacement(const dem::Model& m, std::size_t k) const;
  std::vector<Vec3> displacements(const dem::Model& m) const;
  /// The gap of the present ties alone.
  std::vector<Vec3> freshGap(const dem::Model& m) const;

  /// Parts that belong to the overlap; rows keep what they had.
  void ready(const dem::Model& m);
  std::vector<Vec3> inRows(std::span<const Vec3> values, std::span<const int> nodes) const;
  void number(const dem::Particles& particles);
  void turnKept();
  void updateGap(const dem::Model& m, bool timeless);
  /// J. @param forces  that answer the present gap
  double storedWith(std::span<const Vec3> forces) const;
  void advance(const dem::Model& m);
  void slip();
  void slipMembers(const dem::Model& m);
  void comply(dem::Model& m, std::span<const Vec3> goal);
  void evaluate(dem::Model& m, const dem::Step& step);
  void apply(dem::Model& m, const dem::Step& step);
  void loadNodes(std::span<const Vec3> forces, coupling::NodalLoad& load) const;
  /// Of the gap, m/s², under the forces of the particles and those on the nodes, N.
  std::vector<Vec3> accelerationUnder(const dem::Model& m, std::vector<Vec3> onNodes) const;
  void answerForces(const dem::Model& m);
  void answerMacroStep(const GapRates& rates, bool ends);
  void evaluateMacroStep(const dem::Model& m, double half);
  std::vector<Vec3> answered(const dem::Model& m, std::span<const Vec3> impulses) const;

  void watch(dem::Model& m, const dem::Step& step);
  void findNear(const dem::Model& m);
  void findStrangers(const dem::Model& m, const OverlapLocator& locator);
  void relocate(dem::Model& m);
  OverlapUpdate lookAgain(const dem::Model& m, const OverlapLocator& locator);
  bool isBeyond(const FoundParticle& found) const;
  void change(OverlapUpdate& update, int particle, double before, const FoundParticle& found,
              const fem::CellPlace& last) const;
  void tieAnew(dem::Model& m, OverlapUpdate& update);
  void handOver(dem::Model& m, const OverlapUpdate::Change& change, std::vector<Vec3>& impulse);
  void kickNodes(std::span<const Vec3> impulse);
  void keepForces(const dem::Model& m);
  void keepGap(const dem::Model& m);
  void startGapAnew(const dem::Model& m);
  void weighPairs(dem::Model& m, std::span<const char> isMoved);
};

inline double sumOfProducts(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0.0;
  for (std::size_t r = 0; r < a.size(); ++r) sum += dot(a[r], b[r]);
  return sum;
}

/// Contacts of some particles: pairs of the list, at walls and surfaces, and bonds.
class ContactsOf {
public:
  /// @param isMoved  one per particle   @param solid  whose surface does not meet them
  ContactsOf(const dem::Model& m, std::span<const char> isMoved, const fem::Model* solid);
  /// J that they store with the weights that they have now, with what springs that slide or end are yet to lose in this
  /// step. @param m  left as it is, with the same pairs and terms
  double energy(const dem::Model& m) const;

private:
  std::vector<std::size_t> pairs_;
  std::vector<const dem::Term*> terms_;
};

}  // namespace dovetail::arlequin
