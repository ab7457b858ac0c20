#include <cstdio>
#include <iostream>

#include "dovetail/core/error.hpp"
#include "options.hpp"
#include "output.hpp"
#include "summary.hpp"
#include "run.hpp"

int main(int argc, char** argv) {
  using namespace dovetail;
  try {
    cantilever::Settings settings;
    if (!cantilever::parseOptions(argc, argv, settings)) return 0;
    cantilever::prepareOutputs(settings);
    std::unique_ptr<cantilever::FrameWriter> frames;
    if (!settings.out.empty()) frames = cantilever::makeFrameWriter(settings.out, settings);
    auto result = cantilever::run(settings, frames ? cantilever::Observer([&](const cantilever::Frame& f){frames->write(f);}) : cantilever::Observer{});
    cantilever::compareWithReferences(result);
    if (!settings.out.empty()) cantilever::writeSeries(result);
    if (!settings.summary.empty()) cantilever::writeSummary(settings.summary, result);
    const auto& f = result.figures;
    std::cout << result.ledger << result.profile;
    std::printf("steps %ld wall %.3f us/step %.3f dt %.4e crit %.4e (%s)\nleave %.4f ref %.4f E0 %.6f min %.6f max %.6f drift %.3e ledger %.3e\nlateral %.3e moment %.3e force %.3e nocontact %.4f excess %.3f\nstatic %.4e authors %.4e dyn %.4e dynTime %.4e locked %.4e time %.4e (%.4f) %s\n",
      (long)f.steps, f.wallSeconds, 1e6*f.wallSeconds/double(f.steps), f.dt, f.criticalDt, f.criticalSetter.c_str(), f.leaveTime, f.referenceLeaveTime, f.energyInitial, f.energyMin, f.energyMax, f.energyDrift, f.ledgerResidual,
      f.lateralDrift, f.momentResidual, f.forceResidual, f.noContactShare, f.largestExcess, f.errorStatic, f.errorStaticAuthors, f.errorDynamic, f.errorDynamicSameTime, f.errorDynamicLocked, f.errorDynamicLockedSameTime, f.lockingFactor, f.failure.c_str());
    return f.finished ? 0 : 1;
  } catch (const InputError& error) {
    std::cerr << "cantilever: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "cantilever: " << error.what() << '\n';
    return 1;
  }
}
