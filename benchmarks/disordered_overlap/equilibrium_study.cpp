#include "equilibrium_study.hpp"

#include <fstream>
#include <iostream>
#include <vector>

#include "dovetail/report/text.hpp"

namespace dovetail::disordered_overlap {

namespace {

using report::format;

std::string stressTable(const Corrected& c) {
  std::string text =
      "| layer, m | grains, Pa | solid, Pa | both, Pa | over the weight above | over that in the packing | over mean "
      "density × g × depth |\n|---|---|---|---|---|---|---|\n";
  for (std::size_t k = 0; k < c.layers.size(); ++k) {
    const LayerStress& l = c.layers[k];
    const double depth = c.surface - 0.5 * (l.lower + l.upper);
    text += format("| %.3f … %.3f | %.1f | %.1f | %.1f | %.4f | %.4f | %.4f |\n", l.lower, l.upper, l.grains, l.solid,
                   l.carried(), l.carried() / l.above, l.carried() / c.packingAbove[k],
                   l.carried() / (c.meanDensity * standardGravity * depth));
  }
  return text;
}

std::string correctedText(const Corrected& c, std::int64_t steps) {
  return format(
             "Correction: initialEquilibrium in %d rounds, settle in %lld macro steps (%s), brought to rest %.2e of "
             "the elastic "
             "energy.\n",
             c.rounds, static_cast<long long>(c.macroSteps), c.atRest ? "at rest" : "not at rest", c.broughtToRest) +
         format(
             "In %lld steps afterwards: kinetic over elastic energy at most %.2e, grains moved %.2e diameters at most, "
             "stress of a layer changed by %.2e at most, residual of the ledger %.2e of the elastic energy.\n\n",
             static_cast<long long>(steps), c.kinetic, c.moved, c.stressDrift, c.residual);
}

/// @param grows  whether the solid ends where the longest overlap does, or where each one does
std::string peakTable(const dem::Model& packing, bool quick, bool grows) {
  std::string text =
      "| overlap, diameters | without correction: peak of kinetic over elastic energy | J | with initialEquilibrium "
      "alone | J "
      "|\n|---|---|---|---|---|\n";
  EquilibriumOptions settings;
  for (const int overlap : quick ? std::vector{2, 6} : std::vector{2, 3, 4, 6}) {
    settings.overlap = overlap;
    if (grows) settings.solid = overlap;
    const Start nothing = peakWithout(packing, settings, false),
                initialEquilibrium = peakWithout(packing, settings, true);
    text += format("| %.1f | %.2e | %.2e | %.2e | %.2e |\n", overlap * settings.element / grain::diameter,
                   nothing.overElastic, nothing.joules, initialEquilibrium.overElastic, initialEquilibrium.joules);
  }
  return text;
}

}  // namespace

void runEquilibriumStudy(const EquilibriumStudy& study) {
  EquilibriumOptions settings;
  settings.steps = study.steps;
  const dem::Model packing = fallenColumn(settings.size);
  const Corrected corrected = runCorrected(packing, settings);
  std::string text = "## Column under gravity\n\n" + correctedText(corrected, settings.steps) + stressTable(corrected);
  text += "\nThe solid grows with the overlap, which begins at the packing's floor:\n" +
          peakTable(packing, study.quick, true);
  text += "\nThe overlap grows downwards in the same solid:\n" + peakTable(packing, study.quick, false);
  std::cout << text;
  std::ofstream(study.folder / "equilibrium.md") << text;
}

}  // namespace dovetail::disordered_overlap
