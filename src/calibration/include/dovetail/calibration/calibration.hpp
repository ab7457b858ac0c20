// Contents of a calibration file, as plain structures: experiments on scenes, what they should give, and the parameters
// of the scenes that are sought. All quantities are in SI units. Keys, help and limits are in keys.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "dovetail/scene/basics.hpp"
#include "dovetail/scene/units.hpp"

namespace dovetail::scene {
class Fields;
}

namespace dovetail::calibration {

inline constexpr scene::Quantity requiredQuantity{scene::required, {}};

/// A value at a path of a scene's keys, or of a parameter in its "let".
struct Setting {
  std::string key, value;
};
/// How the grains of a scene, periodic along all axes, become the cell of the experiment.
struct Preparation {
  double pressure = scene::required;  ///< Pa
  std::optional<double> friction;     ///< of the grains until the pressure is there; not given: their own
};
/// Density, elastic moduli, speeds of waves.
struct ModuliProbe {
  Preparation preparation;
  double strain = 1e-5;
};
/// Drained triaxial compression along z.
struct TriaxialProbe {
  Preparation preparation;
  double strain = 0.05;
  int increments = 100;
};
/// The scene as it is: columns of its series.
struct RunProbe {};

struct Experiment {
  std::string name, scene;  ///< the scene's file
  std::vector<Setting> set;
  std::variant<ModuliProbe, TriaxialProbe, RunProbe> probe;
  std::string where;
};

/// Sought: a parameter of the scenes. Where a scene has it under the key, it is set there.
struct Parameter {
  std::string key;
  scene::Quantity start = requiredQuantity, least = requiredQuantity, most = requiredQuantity;
  double step = 0.02;  ///< of differences, over the range of the parameter
  std::string where;
};

/// What a quantity of an experiment should be.
struct Target {
  std::string of, quantity;
  std::optional<double> at;  ///< strain or time, of curves; not given: the end
  scene::Quantity value = requiredQuantity;
  scene::Quantity uncertainty{0.0, {}, false};  ///< standard deviation; 0: 1 % of the value
  std::string where;

  double deviation() const;
};

/// The measure √Σ((quantity − value)/uncertainty)² is sampled in place of being fitted.
struct Search {
  int samples = 9;      ///< along each parameter
  int refinements = 2;  ///< closer samples about the best one
};

struct Calibration {
  std::string title;
  scene::Parameters let;
  std::vector<Experiment> experiments;
  std::vector<Parameter> parameters;
  std::vector<Target> targets;
  std::optional<Search> search;
  int evaluations = 500;    ///< of the simulator, at most
  double tolerance = 1e-3;  ///< see FitOptions
};

void describe(scene::Fields& f, Setting& v);
void describe(scene::Fields& f, ModuliProbe& v);
void describe(scene::Fields& f, TriaxialProbe& v);
void describe(scene::Fields& f, RunProbe& v);
void describe(scene::Fields& f, Experiment& v);
void describe(scene::Fields& f, Parameter& v);
void describe(scene::Fields& f, Target& v);
void describe(scene::Fields& f, Search& v);
void describe(scene::Fields& f, Calibration& v);

/// Reads a calibration file, by the rules of scenes.
/// @throws InputError as scene::readScene; for names of experiments that occur twice, targets of none, quantities that
/// an
///   experiment does not have or of another unit, and bounds that do not enclose the start
Calibration readCalibration(const std::filesystem::path& file, const std::vector<std::string>& settings = {});

/// JSON Schema and reference of calibration files.
std::string schemaText();
std::string referenceText();

}  // namespace dovetail::calibration
