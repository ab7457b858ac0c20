#include "reference/moving_mass.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "reference/surface_contact.hpp"

namespace dovetail::cantilever {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

struct MovingMassState {
  Vector2d x, v;  // particles: (y, z)
  VectorXd q, p;  // modal amplitudes and velocities
  SphereContact contact;
};

struct MovingMassModel {
  double mass, weight, startHeight;
  Eigen::ArrayXd omegaSquared;
};

void kick(const MovingMassModel& model, double dt, MovingMassState& state) {
  state.v += dt / model.mass * (state.contact.force - Vector2d(0.0, model.weight));
  state.p.array() += dt * (state.contact.modalForce.array() - model.omegaSquared * state.q.array());
}

void drift(double dt, MovingMassState& state) {
  state.x += dt * state.v;
  state.q += dt * state.p;
}

double totalEnergy(const MovingMassModel& model, const MovingMassState& state) {
  const double beam = 0.5 * (state.p.squaredNorm() + (model.omegaSquared * state.q.array().square()).sum());
  return 0.5 * model.mass * state.v.squaredNorm() + model.weight * (state.x[1] - model.startHeight) + beam +
         state.contact.energy;
}

void record(double time, const MovingMassState& state, DynamicReference& reference) {
  reference.time.push_back(time);
  reference.y.push_back(state.x[0]);
  reference.z.push_back(state.x[1]);
  reference.vy.push_back(state.v[0]);
  reference.vz.push_back(state.v[1]);
}

void validate(const ModalOptions& settings, const BeamModes& modes) {
  requirePositive(settings.dt, "dt");
  requirePositive(settings.sampleInterval, "sampleInterval");
  requirePositive(settings.maxTime, "maxTime");
  if (settings.theory.supports != Supports::clampedFree)
    throw InputError("the moving mass needs a cantilever", "theory.supports", "use Supports::clampedFree");
  if (settings.dt * modes.omega.back() >= 2.0)
    throw InputError("dt = " + formatNumber(settings.dt) + " s is unstable for the highest mode", "dt",
                     "use less than " + formatNumber(2.0 / modes.omega.back()) + " s, or fewer modes");
}

MovingMassState startState(const BeamCase& beam, int modes) {
  MovingMassState state;
  state.x = {beam.startY, startHeight(beam)};
  state.v = {beam.startVelocity, 0.0};
  state.q.setZero(modes);
  state.p.setZero(modes);
  state.contact.position = beam.startY;
  return state;
}

void integrate(const MovingMassModel& model, const BeamCase& beam, const ModalOptions& settings,
               BeamSurfaceContact& contact, MovingMassState& state, DynamicReference& reference) {
  const double dt = settings.dt;
  const auto stride = static_cast<long>(std::ceil(settings.sampleInterval / dt * (1.0 - 1e-12)));
  contact.update(state.x, state.q, state.contact);
  record(0.0, state, reference);
  const double startEnergy = totalEnergy(model, state);
  double drifted = 0.0;
  long separated = 0, step = 0;
  while (state.x[0] < beam.length) {
    if (static_cast<double>(step) * dt > settings.maxTime)
      throw NumericalError("the particles are still on the beam", "t = " + formatNumber(settings.maxTime) + " s",
                           "raise maxTime or check the case");
    kick(model, 0.5 * dt, state);
    drift(dt, state);
    contact.update(state.x, state.q, state.contact);
    kick(model, 0.5 * dt, state);
    ++step;
    separated += state.contact.overlap <= 0.0;
    drifted = std::max(drifted, std::abs(totalEnergy(model, state) - startEnergy));
    if (step % stride == 0 || state.x[0] >= beam.length) record(static_cast<double>(step) * dt, state, reference);
  }
  reference.startEnergy = startEnergy;
  reference.energyDriftRelative = drifted / startEnergy;
  reference.separatedFraction = static_cast<double>(separated) / static_cast<double>(step);
}

}  // namespace

DynamicReference simulateMovingMassBeam(const BeamCase& beam, const ModalOptions& settings) {
  const BeamModes modes = computeModes(makeSection(beam), beam.length, settings.theory, settings.modes);
  validate(settings, modes);
  if (!(beam.startY >= 0.0 && beam.startY < beam.length))
    throw InputError("the particles do not start on the beam", "startY", "give a value in [0, length)");
  const ModeTable table(modes, settings.tableCells, settings.largeRotations);
  const double half = beam.height / 2.0;
  BeamSurfaceContact contact(table, {.height = half, .lever = settings.surfaceOffset ? half : 0.0},
                             beam.particles * beam.contactStiffness, beam.particleRadius);
  MovingMassModel model{.mass = beam.particles * beamParticleMass(beam),
                        .weight = totalWeight(beam),
                        .startHeight = startHeight(beam),
                        .omegaSquared = {}};
  model.omegaSquared = Eigen::Map<const Eigen::ArrayXd>(modes.omega.data(), settings.modes).square();
  MovingMassState state = startState(beam, settings.modes);
  DynamicReference reference;
  integrate(model, beam, settings, contact, state, reference);
  reference.leaveTime = reference.timeAtY(beam.length);
  return reference;
}

}  // namespace dovetail::cantilever
