#include "reference/static_reference.hpp"

#include <algorithm>

namespace dovetail::cantilever {

double staticDeflection(const Section& section, double force, double arm, bool shear) {
  const double a = std::max(arm, 0.0);
  return force * (a * a * a / (3.0 * section.bending) + (shear ? a / section.shear : 0.0));
}

double staticHeight(const BeamCase& beam, double y, const StaticOptions& settings) {
  return startHeight(beam) -
         staticDeflection(makeSection(beam), totalWeight(beam), y - settings.armOrigin, settings.shear);
}

}  // namespace dovetail::cantilever
