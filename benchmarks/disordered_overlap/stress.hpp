// The vertical stress that a joined column carries, grains and solid together.
#pragma once

#include <vector>

#include "column.hpp"

namespace dovetail::disordered_overlap {

/// A layer of elements of the overlap, as high as they are now; compression > 0.
struct LayerStress {
  double lower, upper;  ///< m
  double grains;        ///< Love–Weber stress of the weighed contacts, averaged over the layer, Pa
  double solid;         ///< (1 − w) P_zz, averaged over the layer, Pa
  double above;         ///< weight of both models above, averaged over the layer, over the section, Pa
  double carried() const { return grains + solid; }
};

/// The layers of elements that grains and solid share, from the lowest up. The run has started.
std::vector<LayerStress> layersOf(JoinedColumn& column, const SolidPlace& place);

/// Weight of the grains above, averaged between two heights, over the section, Pa.
double weightAbove(const dem::Particles& p, double width, double lower, double upper);

}  // namespace dovetail::disordered_overlap
