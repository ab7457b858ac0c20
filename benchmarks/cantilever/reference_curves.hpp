// The authors' deposited curves, if the user has them: --reference DIR.
#pragma once

#include <string>
#include <vector>

namespace dovetail::cantilever {

/// One deposited run: cantilever_c<width>d.csv with columns t_s, x1_m, y1_m, z1_m, …, Eel_DE_J, …, Etot_J.
struct ReferenceCurve {
  double cgWidth = 0.0;                        ///< particle diameters
  std::vector<double> t;                       ///< s
  std::vector<double> x1, y1, z1, x2, y2, z2;  ///< m; y is counted from the clamp here (the files count from mid-span)
  std::vector<double> energy;                  ///< total, J
  std::vector<double> contactEnergy;           ///< elastic energy of the contacts, J
};

/// Reads every cantilever_c*d.csv of the folder, narrow widths first.
/// @throws InputError if the folder has none, or a file lacks a column or holds something that is no number
std::vector<ReferenceCurve> readReferenceCurves(const std::string& folder);

/// The figures of a run that the report compares.
struct CurveFigures {
  double leaveTime;      ///< s, particle 1 passes y = 12 m
  double largestEnergy;  ///< J, until then
  double finalEnergy;    ///< J, last row
  double errorTrueArm;   ///< m, time mean of √Σ(Δx² + Δz²) against static Euler–Bernoulli, arm from the clamp
  double errorAuthorsArm;    ///< m, the same with the arm from the start point, y − 0.2 m
  double noContactFraction;  ///< fraction of rows until then without elastic energy in the contacts
};
CurveFigures figuresOf(const ReferenceCurve& curve);

}  // namespace dovetail::cantilever
