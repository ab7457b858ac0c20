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
  f.box({"box", "its edges are the periods"}, v.box);
  f.axes({"axes", "along which space repeats"}, v.axes, true);
}
void describe(Fields& f, Domain& v) {
  static constexpr const char* policies[] = {"refuse", "remove"};
  f.where(v.where);
  f.box({"box", "where centres of grains may be"}, v.box);
  f.choice({"escape", "who leaves it ends the run, or leaves the scene"}, v.removes, policies);
}

// ---- the run

void describe(Fields& f, Relax& v) {
  f.number({"kinetic", "kinetic over elastic energy below which all is at rest"}, v.kinetic, between(0.0, 1.0, true));
  f.integer({"macro_steps", "macro steps after which it is given up"}, v.macroSteps, 1, many);
}
void describe(Fields& f, RunFor& v) { f.number({"time", "that is simulated"}, v.time, positive(unit::time)); }
void describe(Fields& f, Stage& v) {
  static constexpr const char* kinds[] = {"relax", "run"};
  f.where(v.where);
  f.oneOf({"do", "bring all to rest by kinetic damping, or run for a time"}, v.kind, kinds);
}
void describe(Fields& f, Steps& v) {
  static constexpr const char* automatic[] = {"auto"};
  static constexpr const char* lags[] = {"none", "load", "load-and-skin"};
  f.where(v.where);
  f.numberOrWord({"dt", "time step of the grains"}, v.dt, positive(unit::time), automatic);
  f.number({"safety", "fraction of the critical step that \"auto\" takes; impacts take eight steps, or more"}, v.safety,
           between(0.0, 1.0, true));
  f.integer({"per_macro_step", "K: steps of the grains per step of the solids"}, v.stepsPerMacroStep, 1, 100000);
  f.choice(
      {"lag",
       "of what solids feel: none; or, to compare with staggered schemes of the literature, loads one step old, or "
       "loads and surfaces. A lag makes energy; what it makes is in the ledger"},
      v.lag, lags);
  f.integer({"threads", "0: one per processor; results are the same for any number"}, v.threads, 0, 1024);
}
void describe(Fields& f, Scene& v) {
  f.text({"title", "one line about the scene"}, v.title, false);
  f.includes({"include", "scenes that this one goes on from: its own values win, lists of objects grow"});
  f.parameters({"let",
                "parameters of expressions: a number with or without a unit, or an expression of those above; names "
                "are of less than 100 letters, digits and '_', with a letter first"},
               v.parameters);
  f.vector({"gravity", "acceleration"}, v.gravity, unit::acceleration);
  f.object({"contact", "law of contacts between grains, with walls and with solids"}, v.contact);
  f.list({"contacts", "laws between contact materials; contact is that of all other pairs"}, v.contacts);
  f.object({"periodic", "space that repeats"}, v.periodic);
  f.object({"domain", "where grains may be"}, v.domain);
  f.list({"particles", "groups of spheres"}, v.particles);
  f.list({"walls", "rigid walls"}, v.walls);
  f.list({"clumps", "rigid bodies of spheres"}, v.clumps);
  f.list({"insertions", "grains that enter"}, v.insertions);
  f.list({"outlets", "regions in which grains leave"}, v.outlets);
  f.list({"bonds", "elastic beams between grains, which break"}, v.bonds);
  f.list({"drives", "grains that follow a path"}, v.drives);
  f.list({"solids", "bodies of finite elements"}, v.solids);
  f.list({"couplings", "between grains and solids"}, v.couplings);
  f.object({"steps", "time steps"}, v.steps);
  f.list({"stages", "what is done, in this order"}, v.stages, true);
  f.object({"output", "what is written"}, v.output);
}

}  // namespace dovetail::scene
