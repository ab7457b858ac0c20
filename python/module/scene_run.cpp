#include "scene_run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::python {

namespace {

std::vector<int> byIds(const dem::Particles& particles) {
  std::vector<int> grains;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!particles.isOfSolid(i)) grains.push_back(static_cast<int>(i));
  std::ranges::sort(grains, {}, [&](int i) { return particles.id[static_cast<std::size_t>(i)]; });
  return grains;
}

}  // namespace

std::shared_ptr<py::object> held(py::object object) {
  return {new py::object(std::move(object)), [](py::object* one) {
            const py::gil_scoped_acquire lock;
            delete one;
          }};
}

SceneRun::SceneRun(scene::Scene scene, const py::dict& solids)
    : scene_(std::move(scene)), built_(scene::build(scene_)) {
  if (!scene_.stages.empty() && scene_.stages.front().changes)
    throw InputError("the first stage changes something, and steps make no stages", scene_.stages.front().where,
                     "write what it changes where the scene describes it, or run the whole scene");
  addOwnSolids(built_, solids);
  scene::start(built_, scene_);
  row_ = std::make_unique<scene::SeriesRow>(built_, scene_);
}

void SceneRun::requireFree() const {
  if (steps_)
    throw InputError("a step is under way", "Run",
                     "wait for its end; in a force use what the function is given, its time, places and velocities");
  if (held_)
    throw InputError("views of its grains are open", "Run",
                     "end their `with` first; what you need of the run beside them, take before it");
}

scene::Built& SceneRun::built() {
  requireFree();
  if (built_.run->grains.open != 0.0) step([&] { dem::close(built_.run->grains); });
  return built_;
}

/// A part of a step, in which nobody else uses the run.
void SceneRun::step(const std::function<void()>& part) {
  steps_ = true;
  try {
    const py::gil_scoped_release free;
    part();
  } catch (...) {
    broken_ = true;
    steps_ = false;
    throw;
  }
  steps_ = false;
}

scene::Built& SceneRun::hold() {
  scene::Built& all = built();
  held_ = true;
  return all;
}

void SceneRun::requireWhole() {
  requireUnbroken();
  built();
}

void SceneRun::requireUnbroken() const {
  requireFree();
  if (broken_)
    throw InputError("a step of this run was broken off", "Run", "load a state, or make the run anew from its scene");
}

void SceneRun::advance(std::int64_t steps) {
  using Clock = std::chrono::steady_clock;
  requireUnbroken();
  if (steps < 0) throw InputError("the number of steps is " + std::to_string(steps), "advance", "give 0 or more");
  std::int64_t atOnce = 1;
  while (steps > 0) {
    const std::int64_t next = std::min(steps, atOnce);
    const auto begin = Clock::now();
    step([&] { built_.run->advanceOpen(next, next == steps); });
    steps -= next;
    if (Clock::now() - begin < std::chrono::milliseconds(50)) atOnce *= 2;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

void SceneRun::take(const std::vector<char>& state) {
  run().load(state);
  broken_ = false;
}

void SceneRun::addForce(const std::string& name, py::function function) {
  requireWhole();
  const auto call = held(std::move(function));
  const auto force = [this, name, call](const dem::Particles& particles, double time, std::span<Vec3> total) {
    const std::vector<int>& which = grainsNow();
    const py::gil_scoped_acquire lock;
    const Numbers answer = py::cast<Numbers>((*call)(time, rowsOf(particles.x, which), rowsOf(particles.v, which)));
    const Rows forces(answer, which.size(), name);
    for (std::size_t k = 0; k < which.size(); ++k) total[static_cast<std::size_t>(which[k])] += forces[k];
  };
  const dem::Particles& particles = run().grains.particles;
  std::vector<Vec3> tried(particles.size());
  force(particles, run().time(), tried);  // what it refuses, it refuses before anything changes
  run().change([&] { run().grains.terms.add(dem::ExternalForceTerm(name, force)); });
}

const std::vector<int>& SceneRun::grains() {
  built();
  return grainsNow();
}

const std::vector<int>& SceneRun::grainsNow() {
  const dem::Particles& particles = built_.run->grains.particles;
  if (grainsOf_ != particles.revision) grains_ = byIds(particles), grainsOf_ = particles.revision;
  return grains_;
}

}  // namespace dovetail::python
