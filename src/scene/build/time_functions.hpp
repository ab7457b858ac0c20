// Functions of time of a scene: values, and paths with their velocities.
#pragma once

#include <functional>

#include "dovetail/coupling/run.hpp"
#include "dovetail/scene/scene.hpp"

namespace dovetail::scene {

using TimeFunction = std::function<double(double)>;

/// The value at time t ≥ 0, s. Copies may not be evaluated by several threads at once.
TimeFunction functionOf(const TimeValue& value, const Scene& scene);
/// Of all stages in which time passes, s; 1 if there is none.
double durationOf(const Scene& scene);
using PlaceFunction = std::function<double(const Vec3&, double)>;
/// The value at a place, m, and time, s: of any.
PlaceFunction fieldOf(const TimeValue& value, const Scene& scene);
/// Whether it depends on the place, which the other functions here know nothing of.
bool usesPlace(const TimeValue& value);
bool usesPlace(const TimeVector& value);
bool isConstant(const TimeValue& value);
bool isConstant(const TimeVector& value);
/// The numbers of a constant one.
Vec3 constantOf(const TimeVector& value);

/// How far something has come since t = 0, and how fast it goes. Before t = 0 it went on as it did just after.
struct Travel {
  TimeFunction displacement, velocity;
};
/// Time step of the run, s; 0 before it has one. How long the scene runs has no part in what functions give then.
using StepOf = std::function<double()>;
StepOf stepOf(const coupling::CoupledRun& run);
/// Of a displacement: the velocity is its central difference of fourth order with spacings of a tenth of the step.
Travel travelOf(const TimeValue& displacement, const Scene& scene, const StepOf& step = {});
/// Of a velocity: integrated by Gauss' rule of three points over pieces of half a step, from t = 0 on, so that it is
/// the same at the same time, whatever was asked for before. Without a step: pieces of 1e-5 of the time that the scene
/// runs.
Travel travelAt(const TimeValue& velocity, const Scene& scene, const StepOf& step = {});

struct Path {
  std::function<Vec3(double)> displacement, velocity;  ///< m, m/s
};
/// What a structure with a velocity or a displacement in its place tells, component by component.
/// @throws InputError if both are there
std::array<Travel, 3> travels(const TimeVector& velocity, const std::optional<TimeVector>& displacement,
                              const Scene& scene, const StepOf& step = {});
Path pathOf(const TimeVector& velocity, const std::optional<TimeVector>& displacement, const Scene& scene,
            const StepOf& step = {});

}  // namespace dovetail::scene
