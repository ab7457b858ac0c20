// Published figures of the case, with their source; see also reference_curves.hpp for the curves themselves.
#pragma once

#include <array>

namespace dovetail::wave {

/// Share of the energy that is gone once the impulse has passed the overlap (see dissipatedShare), from the output that
/// the authors deposited with Cheng, Thornton, Luding, Hazel and Weinhart, CMAME 403 (2023) 115651.
struct PublishedRun {
  int particlesPerEdge;
  double cgWidth;  ///< element sizes
  double dissipatedShare;
};
inline constexpr std::array<PublishedRun, 12> publishedRuns{{{1, 0.0, 0.332},
                                                             {1, 0.5, 0.332},
                                                             {1, 1.0, 0.332},
                                                             {1, 1.5, 0.296},
                                                             {1, 2.0, 0.306},
                                                             {1, 2.5, 0.305},
                                                             {4, 0.0, 0.542},
                                                             {4, 0.5, 0.556},
                                                             {4, 1.0, 0.557},
                                                             {4, 1.5, 0.546},
                                                             {4, 2.0, 0.522},
                                                             {4, 2.5, 0.489}}};

}  // namespace dovetail::wave
