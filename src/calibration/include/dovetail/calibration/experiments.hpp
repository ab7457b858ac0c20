// Experiments of a calibration: the simulator, with a store of earlier results.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dovetail/calibration/calibration.hpp"
#include "dovetail/calibration/cell_probes.hpp"
#include "dovetail/scene/scene.hpp"

namespace dovetail::calibration {

/// What an experiment gave. Units are SI's, those of a run's columns are in their names.
struct Outcome {
  std::map<std::string, double> numbers;
  std::map<std::string, std::vector<double>> curves;
  std::string abscissa;  ///< curve over which the others are: strain, time_s; empty without curves
  std::string failure;   ///< why it broke down, or was refused with the values; empty: it was done
  double seconds = 0.0;  ///< that it took

  /// A number, or the value of a curve at a place, linear between its points, or its end.
  /// @throws InputError naming what there is, if there is no such quantity or the curve does not reach the place
  double value(const std::string& quantity, const std::optional<double>& at, const std::string& where) const;
};

/// The triaxial curve of an outcome. @throws InputError if it is none
TriaxialCurve triaxialOf(const Outcome& outcome);

/// Does experiments and keeps what they gave, in memory and in a file, under a hash of the scene in full, the probe and
/// the build. Prepared cells are kept, too, the last few of them.
class Laboratory {
public:
  /// @param folder  for the file of results, evaluations.json, which is read if it is there, and the runs' files
  /// @throws InputError if the folder cannot be written, or the file is not one of ours
  explicit Laboratory(std::filesystem::path folder);
  ~Laboratory();
  Laboratory(const Laboratory&) = delete;
  Laboratory& operator=(const Laboratory&) = delete;

  /// @param values  of the parameters, "key=value"; the experiment's scene must have the keys
  /// @throws InputError for scenes that cannot be read
  const Outcome& perform(const Experiment& experiment, const std::vector<std::string>& values);

  std::int64_t simulated = 0, recalled = 0;  ///< experiments run, and those recalled
  double seconds = 0.0;                      ///< that were spent on the former

  /// Writes what has been done since the last time. @throws InputError as io::writeFileAtomically
  void save();

private:
  Outcome simulate(const Experiment& experiment, const scene::Scene& scene);
  const dem::Model& prepared(const scene::Scene& scene, const Preparation& preparation);

  std::filesystem::path folder_;
  std::map<std::string, Outcome> known_;
  std::vector<std::pair<std::string, dem::Model>> cells_;
  double savedAt_ = 0.0;  ///< s, of the clock
  bool unsaved_ = false;
};

}  // namespace dovetail::calibration
