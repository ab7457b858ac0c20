#include <iostream>
#include <memory>

#include "dovetail/core/error.hpp"
#include "options.hpp"
#include "output.hpp"
#include "reference_curves.hpp"
#include "report.hpp"
#include "run.hpp"
#include "study.hpp"
#include "summary.hpp"
#include "velocity_profile.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::wave;

int runOnce(const Settings& settings) {
  std::vector<ReferenceCurve> curves;
  if (!settings.reference.empty()) curves = readReferenceCurves(settings.reference);
  const PreparedRun compute = prepareRun(settings);  // refuses before a folder is made
  const std::unique_ptr<FrameWriter> frames = prepareOutputs(settings);
  io::TimeSeries profile = emptyProfile();
  Observer observer;
  if (!settings.out.empty())
    observer = [&](const Frame& frame) {
      if (frames) frames->write(frame);
      appendProfile(profile, settings, frame);
    };

  RunResult result = compute(observer);
  if (settings.compare) compareWithParticles(result);
  if (!settings.quiet) printReport(std::cout, result);
  if (!settings.quiet && !curves.empty()) printComparison(std::cout, result, curves);
  if (!settings.out.empty()) {
    appendParticlesAlone(profile, result);
    writeTables(result, profile);
  }
  if (!settings.summary.empty()) writeSummary(settings.summary, result);
  if (result.figures.finished) return 0;
  std::cerr << "wave_propagation: " << result.figures.failure << '\n';
  return 1;
}

}  // namespace

/// Exit code 0: the run finished; 1: it broke down, with when and where; 2: the request was refused.
int main(int argc, char** argv) {
  try {
    Settings settings;
    if (!parseOptions(argc, argv, settings)) return 0;
    if (settings.study == Study::none) return runOnce(settings);
    runStudy(settings);
    return 0;
  } catch (const InputError& error) {
    std::cerr << "wave_propagation: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "wave_propagation: " << error.what() << '\n';
    return 1;
  }
}
