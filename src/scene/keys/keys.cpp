// The keys of a scene file, with keys_grains.cpp and keys_solids.cpp: the one place that knows their names, limits and
// help.
#include "keys.hpp"

namespace dovetail::scene {

void Fields::axes(Key key, std::array<bool, 3>& value, bool needed) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < 3; ++k)
    if (value[k]) names.push_back(axisNames[k]);
  wordList(key, names, axisNames, needed);
  for (std::size_t k = 0; k < 3; ++k) value[k] = std::find(names.begin(), names.end(), axisNames[k]) != names.end();
}

// ---- space

void describe(Fields& f, Periodic& v) {
  f.where(v.where);
  f.box({"box", "its edge lengths are the periods"}, v.box);
  f.axes({"axes", "periodic axes"}, v.axes, true);
}
void describe(Fields& f, Domain& v) {
  static constexpr const char* policies[] = {"refuse", "remove"};
  f.where(v.where);
  f.box({"box", "that centres of grains may not leave"}, v.box);
  f.choice({"escape", "a grain that leaves the box ends the run, or is removed"}, v.removes, policies);
}

void describe(Fields& f, Damping& v) {
  f.where(v.where);
  f.number({"rate", "viscous: force over momentum, and moment over angular momentum, of all grains"}, v.rate,
           notNegative(unit::rate));
  f.number({"local", "fraction of each component of force and moment that opposes the motion (non-viscous)"}, v.local,
           between(0.0, 1.0, false, true));
}

// ---- the run

void describe(Fields& f, Relax& v) {
  f.number({"kinetic", "ratio of kinetic to elastic energy below which the system is at rest"}, v.kinetic,
           between(0.0, 1.0, true));
  f.integer({"macro_steps", "largest number of macro steps"}, v.macroSteps, 1, many);
}
void describe(Fields& f, RunFor& v) { f.number({"time", "simulated time"}, v.time, positive(unit::time)); }
void describe(Fields& f, Statics& v) {
  static constexpr const char* controls[] = {"load", "arc-length"};
  f.integer({"load_steps", "in which loads come on; they are halved where there is no equilibrium"}, v.loadSteps, 1,
            100000);
  f.number({"time", "that passes for functions of time, in scenes without grains; none if not given"}, v.time,
           positive(unit::time));
  f.choice({"control",
            "equal parts of the load; or arcs of the path of equilibria, on which the load may fall (snap-through)"},
           v.arcLength, controls);
}
void describe(Fields& f, FindModes& v) {
  f.integer({"count", "of the lowest frequencies of each solid"}, v.count, 1, 1000);
}
void describe(Fields& f, LoadChange& v) {
  f.where(v.where);
  f.text({"solid", "name of the solid"}, v.solid, true);
  describe(f, v.load);
}
void describe(Fields& f, SupportChange& v) {
  f.where(v.where);
  f.text({"solid", "name of the solid"}, v.solid, true);
  describe(f, v.support);
  f.flag({"present", "false: the nodes are let go"}, v.present);
}
void describe(Fields& f, PlaneChange& v) {
  f.where(v.where);
  f.text({"solid", "name of the solid"}, v.solid, true);
  f.integer({"plane", "which item of the solid's \"planes\", counted from 0"}, v.plane, 0, 1000000);
  path(f, v.velocity, v.displacement);
}
void describe(Fields& f, Changes& v) {
  f.where(v.where);
  f.vector({"gravity", "acceleration"}, v.gravity, unit::acceleration);
  f.object({"contact", "in place of the law before"}, v.contact);
  f.list({"contacts", "in place of the laws of these pairs before"}, v.contacts);
  f.list({"walls", "motions, belts and presence of walls"}, v.walls);
  f.list({"loads", "in place of the load of this kind on the same face set"}, v.loads);
  f.list({"supports", "in place of those on the same node set and components; motions go on from there"}, v.supports);
  f.list({"planes", "motions of rigid planes, which go on from there"}, v.planes);
}
void describe(Fields& f, Stage& v) {
  static constexpr const char* kinds[] = {"relax", "run", "statics", "modes"};
  f.where(v.where);
  f.oneOf(
      {"do",
       "bring the system to rest by kinetic damping, run for a time, load the solids alone through equilibria, or find "
       "their frequencies as they are then"},
      v.kind, kinds);
  f.object({"changes",
            "at the start of the stage; they last until a later stage changes them again. The time t of their "
            "expressions counts from the start of this stage"},
           v.changes);
}
void describe(Fields& f, Steps& v) {
  static constexpr const char* automatic[] = {"auto"};
  static constexpr const char* lags[] = {"none", "load", "load-and-skin"};
  f.where(v.where);
  f.numberOrWord({"dt", "time step of the grains"}, v.dt, positive(unit::time), automatic);
  f.number({"safety", "of \"auto\": fraction of the critical step; an impact takes at least eight steps"}, v.safety,
           between(0.0, 1.0, true));
  f.integer({"per_macro_step", "K: steps of the grains per step of the solids"}, v.stepsPerMacroStep, 1, 100000);
  f.choice({"lag",
            "of the coupling to solids: none; or, to compare with staggered schemes, loads of the previous step, or "
            "loads and surface of the previous step. The ledger has the staggering error"},
           v.lag, lags);
  f.integer({"threads", "0: one per processor; results are the same for any number"}, v.threads, 0, 1024);
}
void describe(Fields& f, Scene& v) {
  f.text({"title", "one line about the scene"}, v.title, false);
  f.text({"version", "version of Dovetail for which the scene was written, \"0.1\"; a later one is refused"}, v.version,
         false);
  f.includes({"include", "scenes that this one extends: its own values take precedence, lists of objects are joined"});
  f.parameters({"let",
                "parameters of expressions: a number with or without a unit, or an expression of those above; names "
                "have fewer than 100 letters, digits and '_', with a letter first"},
               v.parameters);
  f.vector({"gravity", "acceleration"}, v.gravity, unit::acceleration);
  f.object({"damping", "of the motion of all grains and clumps, beside that of contacts"}, v.damping);
  f.object({"contact", "law of contacts between grains, with walls and with solids"}, v.contact);
  f.list({"contacts", "laws of pairs of contact materials; all other pairs have the law of \"contact\""}, v.contacts);
  f.object({"periodic", "periodic space"}, v.periodic);
  f.object({"domain", "region that grains may not leave"}, v.domain);
  f.list({"particles", "groups of spheres"}, v.particles);
  f.list({"walls", "rigid walls"}, v.walls);
  f.list({"clumps", "rigid bodies of spheres"}, v.clumps);
  f.list({"insertions", "regions in which grains are inserted"}, v.insertions);
  f.list({"outlets", "regions in which grains are removed"}, v.outlets);
  f.list({"bonds", "elastic beams between grains, which can break"}, v.bonds);
  f.list({"drives", "groups of grains with a prescribed motion"}, v.drives);
  f.list({"cells", "cells of grains, which answer for the deformation of solids"}, v.cells);
  f.list({"solids", "bodies of finite elements"}, v.solids);
  f.list({"couplings", "between grains and solids"}, v.couplings);
  f.object({"steps", "time steps"}, v.steps);
  f.list({"stages", "stages of the run, in this order"}, v.stages, true);
  f.object({"output", "files that are written"}, v.output);
}

}  // namespace dovetail::scene
