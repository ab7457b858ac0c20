// The authors' deposited curves, if the user has them: --reference DIR.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "run.hpp"

namespace dovetail::wave {

/// One deposited run of the impulse: wave_<N>P_c<width>dX.csv (N = n³ particles per element) or wave_<N>P_fullDEM.csv,
/// with columns t_s and Etot_J.
struct ReferenceCurve {
  int particlesPerEdge = 1;
  std::optional<double> cgWidth;  ///< element sizes; none: particles alone
  std::vector<EnergySample> energy;
};

/// Reads every wave_*P_c*dX.csv and wave_*P_fullDEM.csv of the folder, by n and width, particles alone last.
/// @throws InputError if the folder has none, or a file lacks a column or holds something that is no number
std::vector<ReferenceCurve> readReferenceCurves(const std::string& folder);

/// Whether the curve's n and width are those of the run.
bool fits(const ReferenceCurve& curve, const Settings& settings);

/// Largest |E − E_theirs| over the rows of the curve within the run's time, over E_theirs at the start.
double largestDifference(const ReferenceCurve& curve, const std::vector<EnergySample>& energy);

/// Fraction of the energy that is gone once the impulse has passed the overlap (see dissipatedFraction), from the
/// output that the authors deposited with Cheng, Thornton, Luding, Hazel and Weinhart, CMAME 403 (2023) 115651.
struct PublishedRun {
  int particlesPerEdge;
  double cgWidth;  ///< element sizes
  double dissipatedFraction;
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

/// The run beside the authors' deposited curves.
void printComparison(std::ostream& out, const RunResult& result, const std::vector<ReferenceCurve>& curves);

}  // namespace dovetail::wave
