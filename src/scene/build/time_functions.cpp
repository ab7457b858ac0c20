#include "time_functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "dovetail/core/error.hpp"
#include "keys/values.hpp"
#include "own_paths.hpp"
#include "read/parameters.hpp"

namespace dovetail::scene {

namespace {

/// Many nodes ask for the same few times.
template <class Value>
class Remembered {
public:
  explicit Remembered(std::function<Value(double)> function) : function_(std::move(function)) {}
  Value operator()(double t) {
    for (const auto& [time, value] : last_)
      if (time == t) return value;
    std::pair<double, Value>& oldest = last_[next_ = (next_ + 1) % last_.size()];
    oldest = {t, function_(t)};
    return oldest.second;
  }

private:
  std::function<Value(double)> function_;
  std::array<std::pair<double, Value>, 4> last_{{{NAN, {}}, {NAN, {}}, {NAN, {}}, {NAN, {}}}};
  std::size_t next_ = 0;
};
template <class Value>
std::function<Value(double)> remembered(std::function<Value(double)> function) {
  return [all = std::make_shared<Remembered<Value>>(std::move(function))](double t) { return (*all)(t); };
}

/// ∫ v dt from 0 on.
class Integral {
public:
  Integral(TimeFunction velocity, std::function<double()> piece)
      : velocity_(std::move(velocity)), pieceNow_(std::move(piece)) {}
  double operator()(double t) {
    if (const double piece = pieceNow_(); piece != piece_) {
      piece_ = piece;
      last_ = {NAN, 0.0};
      startAgain();
    }
    if (t == last_.first) return last_.second;  // many nodes ask for the same time
    last_ = {t, upTo(t)};
    return last_.second;
  }

private:
  void startAgain() {
    first_ = 0;
    sums_ = {0.0};
  }
  double upTo(double t) {
    const auto whole = static_cast<std::size_t>(std::max(0.0, std::floor(t / piece_)));
    if (whole < first_) startAgain();
    while (first_ + sums_.size() <= whole) {
      const double from = static_cast<double>(first_ + sums_.size() - 1) * piece_;
      sums_.push_back(sums_.back() + over(from, from + piece_));
      if (sums_.size() < kept) continue;
      sums_.erase(sums_.begin(), sums_.begin() + kept / 2);
      first_ += kept / 2;
    }
    return sums_[whole - first_] + over(static_cast<double>(whole) * piece_, t);
  }
  double over(double from, double to) const {
    const double half = 0.5 * (to - from), middle = 0.5 * (from + to), out = std::sqrt(0.6) * half;
    return half / 9.0 * (5.0 * velocity_(middle - out) + 8.0 * velocity_(middle) + 5.0 * velocity_(middle + out));
  }
  TimeFunction velocity_;
  std::function<double()> pieceNow_;
  double piece_ = 0.0;
  static constexpr std::size_t kept = 4096;  // the latest sums: times are asked for one after the other
  std::size_t first_ = 0;                    // whole pieces in the first of them
  std::vector<double> sums_{0.0};
  std::pair<double, double> last_{NAN, 0.0};
};

}  // namespace

double durationOf(const Scene& scene) {
  double time = 0.0;
  for (const Stage& stage : scene.stages)
    if (const auto* const plan = std::get_if<RunFor>(&stage.kind))
      time += plan->time;
    else if (const auto* const steps = std::get_if<Statics>(&stage.kind))
      time += steps->time.value_or(0.0);
  return time > 0.0 ? time : 1.0;
}

bool isConstant(const TimeValue& value) { return value.expression.empty(); }
bool isConstant(const TimeVector& value) {
  return std::all_of(value.begin(), value.end(), [](const TimeValue& one) { return isConstant(one); });
}
Vec3 constantOf(const TimeVector& value) { return {value[0].number, value[1].number, value[2].number}; }

TimeFunction functionOf(const TimeValue& value, const Scene& scene) {
  if (isConstant(value)) return [number = value.number](double) { return number; };
  TimeFunction function = remembered(functionOf(value.expression, scene.parameters));
  try {
    function(0.0);
  } catch (const NumericalError& error) {  // where all runs begin
    throw InputError(error.what(), "", "");
  }
  return function;
}

bool usesPlace(const TimeValue& value) {
  const std::set<std::string> words = wordsIn(value.expression);
  return words.contains("x") || words.contains("y") || words.contains("z");
}
bool usesPlace(const TimeVector& value) {
  return std::any_of(value.begin(), value.end(), [](const TimeValue& one) { return usesPlace(one); });
}

PlaceFunction fieldOf(const TimeValue& value, const Scene& scene) {
  if (!usesPlace(value)) return [at = functionOf(value, scene)](const Vec3&, double t) { return at(t); };
  return fieldOf(value.expression, scene.parameters);
}

StepOf stepOf(const coupling::CoupledRun& run) {
  return [&run] { return run.dt(); };
}

Travel travelOf(const TimeValue& displacement, const Scene& scene, const StepOf& stepNow) {
  if (isConstant(displacement)) return {[u = displacement.number](double) { return u; }, [](double) { return 0.0; }};
  return travelOf(functionOf(displacement, scene), stepNow);
}

Travel travelOf(const TimeFunction& displacement, const StepOf& stepNow) {
  const auto step = [stepNow] {
    constexpr double least = 1e-9;  // s: the step before the start, and where no time passes
    return std::max(least, stepNow ? 0.1 * stepNow() : 0.0);
  };
  const auto path = [f = displacement](double t) { return t < 0.0 ? 2.0 * f(0.0) - f(-t) : f(t); };
  return {path, [path, step](double t) {
            const double h = step();
            return (8.0 * (path(t + h) - path(t - h)) - (path(t + 2.0 * h) - path(t - 2.0 * h))) / (12.0 * h);
          }};
}

Travel travelAt(const TimeValue& velocity, const Scene& scene, const StepOf& stepNow) {
  if (isConstant(velocity))
    return {[v = velocity.number](double t) { return v * t; }, [v = velocity.number](double) { return v; }};
  return travelAt(functionOf(velocity, scene), stepNow, 1e-5 * durationOf(scene));
}

Travel travelAt(const TimeFunction& velocity, const StepOf& stepNow, double before) {
  const auto speed = [f = velocity](double t) { return f(std::max(0.0, t)); };
  const auto piece = [stepNow, before] {
    const double step = stepNow ? stepNow() : 0.0;
    return step > 0.0 ? 0.5 * step : before;
  };
  const auto integral = std::make_shared<Integral>(speed, piece);
  return {[integral](double t) { return (*integral)(t); }, speed};
}

std::array<Travel, 3> travels(const TimeVector& velocity, const std::optional<TimeVector>& displacement,
                              const Scene& scene, const StepOf& step) {
  const bool moves = !isConstant(velocity) || norm(constantOf(velocity)) > 0.0;
  if (displacement && moves)
    throw InputError("both a velocity and a displacement are given", "", "leave one of them out");
  std::array<Travel, 3> all;
  for (std::size_t c = 0; c < 3; ++c)
    all[c] = displacement ? travelOf((*displacement)[c], scene, step) : travelAt(velocity[c], scene, step);
  return all;
}

namespace {
Path pathOf(const std::array<Travel, 3>& all) {
  return {[all](double t) {
            return Vec3{all[0].displacement(t), all[1].displacement(t), all[2].displacement(t)};
          },
          [all](double t) {
            return Vec3{all[0].velocity(t), all[1].velocity(t), all[2].velocity(t)};
          }};
}
}  // namespace

Path pathOf(const TimeVector& velocity, const std::optional<TimeVector>& displacement, const Scene& scene,
            const StepOf& step) {
  return pathOf(travels(velocity, displacement, scene, step));
}

Path pathOf(const std::function<Vec3(double)>& function, bool isVelocity, const StepOf& step) {
  std::array<Travel, 3> all;
  const auto vectors = remembered(function);
  for (int c = 0; c < 3; ++c) {
    const TimeFunction part = [vectors, c](double t) { return vectors(t)[c]; };
    all[static_cast<std::size_t>(c)] = isVelocity ? travelAt(part, step, step()) : travelOf(part, step);
  }
  return pathOf(all);
}

}  // namespace dovetail::scene
