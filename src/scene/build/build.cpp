#include "dovetail/scene/build.hpp"

#include <algorithm>
#include <cmath>

#include "changes.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/impact.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/scene/laws_in_place.hpp"
#include "from_state.hpp"
#include "parts.hpp"
#include "run/frame_fields.hpp"
#include "time_functions.hpp"
#include "warnings/impacts.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

void setLaws(dem::Model& grains, const Scene& scene) {
  if (const auto laws = lawsInPlace()) {
    grains.laws = laws;
    return;
  }
  if (scene.contact || !scene.contacts.empty()) {
    grains.laws = makeLaws(scene);
    return;
  }
  const bool points = std::ranges::any_of(
      scene.couplings, [](const Coupling& one) { return std::holds_alternative<PointSpheres>(one.kind); });
  if (!scene.particles.empty() || !scene.clumps.empty() || !scene.insertions.empty() || points)
    throw InputError(std::string(points ? "material points" : "grains") + " have no contact law", scene.steps.where,
                     "give the scene a key \"contact\"");
  grains.laws = dem::makeContactLaws(dem::ElasticLaw{{.stiffness = 1.0}});  // of a scene without grains
}

/// Of the grains as they lie now, under the laws and with the walls of a later stage.
StepLimit limitOfStage(const Built& built, const Scene& scene, std::size_t stage) {
  const dem::Model grains = grainsAt(built, scene, stage);
  const dem::ContactDemand demand = dem::demandOf(grains);
  const std::string of = "stage " + std::to_string(stage + 1) + ": ";
  StepLimit limit = dem::criticalStep(demand, grains.particles);
  limit.lower(dem::impactLimit(grains, demand));
  limit.owner = of + limit.owner;
  const Impact impact = briefestImpact(lawsAt(scene, stage), grains.particles);
  limit.lower({impact.limit, of + "an impact of the smallest grains" + impact.materials});
  return limit;
}

/// Those that do not depend on how things lie now.
std::vector<StepLimit> limitsOfParts(Built& built, const Scene& scene) {
  std::vector<StepLimit> found;
  for (std::size_t s = 0; s < built.run->solids(); ++s) {
    coupling::SolidSide& side = built.run->solid(s);
    if (side.stepping == coupling::Stepping::implicitSteps) continue;
    StepLimit stable = fem::stableStep(*side.model, side.name);
    stable.dt /= scene.steps.stepsPerMacroStep;
    found.push_back(std::move(stable));
  }
  const Impact impact = briefestImpact(scene, built.run->grains.particles);
  found.push_back({impact.limit, "an impact of the smallest grains" + impact.materials});
  for (std::size_t k = 0; k < scene.stages.size(); ++k)
    if (scene.stages[k].changes) found.push_back(limitOfStage(built, scene, k));
  return found;
}

/// Stability asks for no more than two steps in an impact, which then knows nothing of its energy. A fifth of its limit
/// gives it eight, and the ledger is right to a twentieth of what changes hands. Bonded springs last: infinite.
Impact resolvedImpact(const Built& built, const Scene& scene) {
  constexpr double ofImpact = 0.2;
  const dem::Model& grains = built.run->grains;
  if (std::isinf(grains.laws->reach())) return {};
  Impact impact = briefestImpact(scene, grains.particles);
  for (std::size_t k = 0; k < scene.stages.size(); ++k)
    if (changesLaws(scene.stages[k]))
      if (const Impact then = briefestImpact(lawsAt(scene, k), grains.particles); then.limit < impact.limit)
        impact = then;
  impact.limit *= ofImpact;
  return impact;
}

/// Dashpots see the velocity of half a step ago, which counts where restitution is low.
double stepForRebound(Built& built, const Scene& scene, double longest) {
  const Rebound coarse = worstRebound(built, scene, longest);
  double dt = longest;
  while (worstRebound(built, scene, dt).error() > reboundTolerance && dt > 0.05 * longest) dt *= 0.8;
  built.notes.push_back("The step is " + formatNumber(dt) + " s, so that impacts rebound with their restitution " +
                        formatNumber(coarse.right) + " within " + formatNumber(reboundTolerance) + "; with " +
                        formatNumber(longest) + " s it may be " + rounded(coarse.found) + ".");
  return dt;
}

double automaticStep(Built& built, const Scene& scene, double limit) {
  const auto [resolved, materials] = resolvedImpact(built, scene);
  const double fraction = scene.steps.safety * limit;
  if (const double dt = std::min(fraction, resolved); worstRebound(built, scene, dt).error() > reboundTolerance)
    return stepForRebound(built, scene, dt);
  if (fraction <= resolved) return fraction;
  built.notes.push_back("The step is " + formatNumber(resolved) + " s, so that an impact of the smallest grains" +
                        materials + " takes eight steps; the fraction " + formatNumber(scene.steps.safety) +
                        " of the limit is " + formatNumber(fraction) +
                        " s. Give steps.dt a number if there are no impacts.");
  return resolved;
}

void noteCoarseStep(Built& built, const Scene& scene, double dt) {
  if (const Rebound rebound = worstRebound(built, scene, dt); rebound.error() > reboundTolerance)
    built.notes.push_back("At this step impacts of the smallest grains may rebound with " + rounded(rebound.found) +
                          " where their restitution is " + formatNumber(rebound.right) + ": take a smaller steps.dt.");
  const auto [resolved, materials] = resolvedImpact(built, scene);
  if (dt <= resolved) return;
  built.notes.push_back("The step, " + formatNumber(dt) + " s, gives an impact of the smallest grains" + materials +
                        " " + formatNumber(std::floor(80.0 * resolved / dt) / 10.0) +
                        " steps, too few to conserve its energy; eight need " + formatNumber(resolved) +
                        " s. It is short enough if there are no impacts.");
}

/// What has a steady velocity goes on while a stage relaxes, or is stopped with all else; what stages change is looked
/// at with their changes.
void requireStandstill(const Scene& scene) {
  const auto relaxes = [](const Stage& stage) { return std::holds_alternative<Relax>(stage.kind); };
  if (std::none_of(scene.stages.begin(), scene.stages.end(), relaxes)) return;
  for (const Drive& drive : scene.drives)
    if (norm(constantOf(drive.velocity)) + norm(constantOf(drive.spin)) + norm(drive.angularVelocity) > 0.0)
      throw InputError("a stage relaxes, but a drive has a steady velocity", drive.where,
                       "run for a time in place of relaxing, or let it begin later by a displacement such as "
                       "\"0.1*max(0, t - 1)\"");
}

/// Grains stand still in load steps, which know nothing of them.
void requireStatics(const Scene& scene) {
  const bool anyGrains = !scene.particles.empty() || !scene.clumps.empty() || !scene.insertions.empty();
  for (std::size_t k = 0; k < scene.stages.size(); ++k) {
    const auto* const statics = std::get_if<Statics>(&scene.stages[k].kind);
    const bool modes = std::holds_alternative<FindModes>(scene.stages[k].kind);
    const bool overlaps = std::ranges::any_of(
        scene.couplings, [](const Coupling& one) { return std::holds_alternative<Overlap>(one.kind); });
    if (modes && (scene.solids.empty() || overlaps))
      throw InputError(overlaps ? "modes are those of solids alone, and an overlap ties one to grains"
                                : "a stage finds the modes of solids, and the scene has none",
                       scene.stages[k].where, "leave the stage out");
    if (!statics) continue;
    const auto refuse = [&](const char* what, const char* remedy) {
      throw InputError(what, scene.stages[k].where, remedy);
    };
    if (scene.solids.empty())
      refuse("a static stage loads solids, and the scene has none", "add a solid, or relax or run in its place");
    if (overlaps)
      refuse("load steps know no grains, and an overlap ties them to a solid",
             "relax in its place, or give the overlap \"initial_equilibrium\": true");
    if (statics->arcLength && statics->time)
      refuse("along an arc the load may fall again, and time never does",
             "leave \"time\" out: loads come on from 0 to what they are now, or \"control\"");
    for (const Solid& solid : scene.solids)
      if (statics->arcLength && solid.linearSolver >= 2)
        refuse("conjugate gradients and multigrid cannot pass limit points of the load",
               ("leave the \"linear_solver\" of \"" + solid.name + "\" out, or \"control\"").c_str());
    if (!anyGrains) continue;
    if (statics->time)
      refuse("time passes in a static stage, and grains would stand still meanwhile",
             "leave \"time\" out, or the grains");
    if (k > 0 && !std::holds_alternative<Statics>(scene.stages[k - 1].kind))
      refuse("load steps know no grains, which may lie on the solids by then",
             "let static stages be the first ones, or relax in their place");
  }
}

/// Explicit steps know the velocity of half a step ago.
void requireSlowDamping(const Built& built, const Scene& scene) {
  constexpr double most = 0.5;
  if (scene.damping && scene.damping->rate * built.run->dt() > most)
    throw InputError("the damping rate is " + formatNumber(scene.damping->rate) + " 1/s, " +
                         rounded(scene.damping->rate * built.run->dt()) + " in a step of the grains",
                     scene.damping->where, "take a lower one, or a smaller step");
  for (std::size_t s = 0; s < scene.solids.size(); ++s)
    if (const Solid& solid = scene.solids[s]; !solid.implicitSteps && solid.massDamping * built.run->macroStep() > most)
      throw InputError("mass_damping is " + formatNumber(solid.massDamping) + " 1/s, " +
                           rounded(solid.massDamping * built.run->macroStep()) + " in a step of \"" + solid.name + "\"",
                       solid.where, "take a lower one, a smaller step, or \"stepping\": \"implicit\"");
}

}  // namespace

Built build(const Scene& scene, bool onRanks) {
  requireStandstill(scene);
  requireStatics(scene);
  if (scene.steps.threads > 0) setThreads(scene.steps.threads);
  Built built;
  built.onRanks = onRanks;
  built.run = std::make_unique<coupling::CoupledRun>();
  dem::Model& grains = built.run->grains;
  setLaws(grains, scene);
  grains.gravity = scene.gravity;
  *built.changing.gravity = scene.gravity;
  if (scene.periodic) grains.pairs.setPeriodicity({scene.periodic->box, scene.periodic->axes});
  if (scene.damping) {
    dem::damping(grains).viscousRate = scene.damping->rate;
    dem::damping(grains).local = scene.damping->local;
  }
  if (scene.domain)
    grains.domain =
        dem::Domain{scene.domain->box, scene.domain->removes ? dem::EscapePolicy::remove : dem::EscapePolicy::refuse};
  Groups groups = addParticles(grains, scene, built.notes);
  if (std::isinf(grains.laws->reach())) dem::findPairs(grains.particles, grains.pairs);  // those that hold together
  addClumps(grains, scene, groups);
  addBondsAndDrives(built, scene, groups);
  addWalls(built, scene);
  addStreams(grains, scene);
  addCells(built, scene);
  addSolids(built, scene);
  addCouplings(built, scene);
  requireTogether(built, scene);
  takeContacts(built, scene);
  requireChanges(built, scene);
  return built;
}

namespace {

/// How the linear systems of the solids are going to be solved.
void foreseeSolvers(Built& built) {
  for (std::size_t s = 0; s < built.run->solids(); ++s) {
    const linalg::LinearForecast& forecast = built.forecasts.emplace_back(built.run->forecast(s));
    if (forecast.method == linalg::LinearMethod::direct) continue;
    const bool multigrid = forecast.method == linalg::LinearMethod::multigrid;
    const auto gibibytes = [](double bytes) { return formatNumber(std::round(10.0 * bytes / 1073741824.0) / 10.0); };
    built.notes.push_back(
        "Solid \"" + built.run->solid(s).name + "\" is solved by " + (multigrid ? "multigrid" : "conjugate gradients") +
        (forecast.factors > 0.0 ? ": its factors would take " + gibibytes(forecast.factors) + " GiB." : "."));
  }
}

/// Which depend on the mesh: rims of pressures that follow the faces.
void requireSymmetry(const Built& built, const Scene& scene) {
  const auto stage =
      std::ranges::find_if(scene.stages, [](const Stage& one) { return std::holds_alternative<FindModes>(one.kind); });
  if (stage == scene.stages.end()) return;
  for (std::size_t s = 0; s < built.run->solids(); ++s)
    for (const auto& term : built.run->solid(s).model->terms)
      if (!term->isSymmetric())
        throw InputError("the tangent of \"" + term->name() + "\" of \"" + built.run->solid(s).name +
                             "\" is not symmetric, so that there may be no modes",
                         stage->where,
                         "take pressures with \"follows\": false, planes without friction, and materials whose tangent "
                         "is symmetric");
}

void requireStableStages(const Built& built, const Scene& scene, double dt) {
  for (std::size_t k = 0; k < scene.stages.size(); ++k) {
    if (!scene.stages[k].changes) continue;
    const StepLimit limit = limitOfStage(built, scene, k);
    if (dt > limit.dt)
      throw InputError("dt = " + formatNumber(dt) + " s exceeds the critical step of " + formatNumber(limit.dt) +
                           " s, set by " + limit.owner,
                       "", "take a fifth of the limit or less");
  }
}

bool nothingIsThere(const Built& built, const Scene& scene) {
  return built.run->grains.particles.size() == 0 && built.run->solids() == 0 && scene.insertions.empty();
}

}  // namespace

void start(Built& built, const Scene& scene) {
  bool allLeave = false;
  const coupling::RunOptions options{.stepsPerMacroStep = scene.steps.stepsPerMacroStep,
                                     .lag = static_cast<coupling::Lag>(scene.steps.lag)};
  atPlace(scene.steps.where, [&] {
    if (scene.steps.dt.word.empty()) {
      built.run->start(scene.steps.dt.number, options);
      requireStableStages(built, scene, scene.steps.dt.number);
      return noteCoarseStep(built, scene, scene.steps.dt.number);
    }
    double smallest = built.run->limitAtStart(options).dt;
    for (const StepLimit& limit : limitsOfParts(built, scene)) smallest = std::min(smallest, limit.dt);
    allLeave = scene.domain && nothingIsThere(built, scene);
    if (allLeave) return;
    if (!std::isfinite(smallest))
      throw InputError(nothingIsThere(built, scene) ? "the scene has neither grains nor solids"
                                                    : "nothing in the scene sets a time step",
                       "", "give steps.dt a number, such as \"1e-4 s\"");
    built.run->start(automaticStep(built, scene, smallest), options);
  });
  if (allLeave)
    throw InputError("all grains lie outside of the domain and are removed at once", scene.domain->where,
                     "make domain.box larger, or move the grains into it");
  requireSlowDamping(built, scene);
  requireSymmetry(built, scene);
  for (const std::string& note : notesOnSetNames(built, scene)) built.notes.push_back(note);
  requireHeldCells(built, scene);
  foreseeSolvers(built);
}

std::vector<StepLimit> limits(Built& built, const Scene& scene) {
  std::vector<StepLimit> found = limitsOfParts(built, scene);
  const StepLimit now = built.run->criticalStep();
  found.push_back({now.dt, "the whole as it is now (" + now.owner + ")"});
  return found;
}

}  // namespace dovetail::scene
