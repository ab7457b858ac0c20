// The authors' deposited curves, if the user has them: --reference DIR.
#pragma once

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

}  // namespace dovetail::wave
