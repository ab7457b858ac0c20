#include <limits>
#include <memory>
#include <vector>

#include "dovetail/core/error.hpp"
#include "model.hpp"
#include "run.hpp"

namespace dovetail::cantilever {

const DynamicReference& dynamicReference(const Settings& settings, double bendingFactor) {
  struct Entry {
    double stiffness, factor;
    DynamicReference reference;
  };
  static std::vector<std::unique_ptr<Entry>> kept;
  BeamCase beam = beamCase(settings);
  beam.bendingFactor = bendingFactor;
  for (const auto& entry : kept)
    if (entry->stiffness == beam.contactStiffness && entry->factor == bendingFactor) return entry->reference;
  kept.push_back(std::make_unique<Entry>(
      Entry{beam.contactStiffness, bendingFactor, simulateMovingMassBeam(beam, ModalOptions{})}));
  return kept.back()->reference;
}

bool comparesWithBeam(const RunResult& result) { return result.figures.left || !result.settings.until; }

void compare(RunResult& result) {
  RunFigures& f = result.figures;
  if (result.samples.size() < 2) return;
  const BeamCase beam = beamCase(result.settings);
  f.errorStatic = errorFromStatic(result.samples, beam).mean;
  f.errorStaticAuthors = errorFromStatic(result.samples, beam, {.armOrigin = Case{}.startY}).mean;
  std::vector<PairSample> straight = result.samples;
  for (PairSample& sample : straight) {
    sample.x[0].x = Case{}.startX;
    sample.x[1].x = -Case{}.startX;
  }
  f.errorStaticVertical = errorFromStatic(straight, beam).mean;
  const auto compare = [&](double bendingFactor, double& atY, double& atTime) {
    atY = atTime = std::numeric_limits<double>::quiet_NaN();
    if (!comparesWithBeam(result)) return atY;
    try {
      const DynamicReference& reference = dynamicReference(result.settings, bendingFactor);
      atY = errorFromDynamicAtY(result.samples, beam, reference).mean;
      atTime = errorFromDynamicAtTime(result.samples, beam, reference).mean;
      return reference.leaveTime;
    } catch (const Error&) {  // the contact is too stiff for the reference, or a blown-up run is where it never was
      return std::numeric_limits<double>::quiet_NaN();
    }
  };
  f.referenceLeaveTime = compare(1.0, f.errorDynamic, f.errorDynamicSameTime);
  compare(f.lockingFactor, f.errorDynamicLocked, f.errorDynamicLockedSameTime);
}

}  // namespace dovetail::cantilever
