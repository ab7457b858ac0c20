// Bodies of plastic metal with known limits: a thick tube under pressure, a bar and a strip that neck.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"

namespace dovetail::fem {

/// A tube in plane strain (bricks are held) whose bore is pushed outwards, perfectly plastic, with so small an elastic
/// strain that the geometry does not change. Bore 1 m, outer radius 2 m.
struct Tube {
  static constexpr double inner = 1.0, outer = 2.0, young = 1e12, yieldStress = 1e8;
  ElementShape shape = ElementShape::hex8;
  Formulation formulation = Formulation::meanDilatation;
  double poissonRatio = 0.3;
  int radial = 10, around = 6;  ///< cells; one in z
  int steps = 12;

  /// (2/√3) σ_y ln(b/a), Pa: the limit of the pressure (Hill 1950, The Mathematical Theory of Plasticity, ch. V).
  static double limitPressure();
};

struct TubeResult {
  std::vector<double> displacement;  ///< of the bore, m
  std::vector<double> pressure;      ///< on it, Pa
  std::int64_t iterations;
  double seconds;
};
TubeResult pressurise(const Tube& tube);

/// The necking bar of Simo & Hughes (Computational Inelasticity, 1998, section 9.3; Simo 1988, Comput. Methods Appl.
/// Mech. Engng 68): one eighth of it, the middle section in z = 0, 1.8 % thinner there.
struct NeckingBar {
  static constexpr double radius = 6.413e-3, halfLength = 26.667e-3, thinning = 0.018;  // m
  Formulation formulation = Formulation::meanDilatation;
  int across = 2, around = 2, along = 10;  ///< cells of the core of the O-grid, of its rim, and along the half length
  double elongation = 7e-3;                ///< of the half length, m
  double largestStep = 0.25e-3;            ///< m

  static J2Plasticity material();
  /// Greatest force of an even bar of the nominal section, N: A₀ max σ_y(a) e^(−ε) (Considère 1885).
  static double considereForce();
};

struct NeckingStep {
  double elongation;     ///< of the half length, m
  double force;          ///< on the whole section, N
  double neckRadius;     ///< m
  double neckCurve;      ///< 1/m: curvature of the profile there
  double flowStress;     ///< σ_y in the neck, averaged over its section, Pa
  double deepestStrain;  ///< largest accumulated plastic strain
};
struct NeckingResult {
  std::vector<NeckingStep> steps;
  std::size_t cells;
  std::int64_t iterations;
  int cuts;
  double seconds;
  double energyResidual;  ///< fraction of the work
};
NeckingResult stretch(const NeckingBar& bar);

/// A strip of the same steel, length and taper in plane strain, as wide as the bar is thick: one quarter of it, its
/// middle section in y = 0.
struct NeckingStrip {
  static constexpr double halfWidth = NeckingBar::radius, halfLength = NeckingBar::halfLength;  // m
  ElementShape shape = ElementShape::quad4;
  Formulation formulation = Formulation::meanDilatation;
  int across = 4, along = 10;    ///< cells of the quarter
  double elongation = 5e-3;      ///< of the half length, m
  double largestStep = 0.25e-3;  ///< m

  /// Greatest force of an even strip of the nominal width and 1 m thickness, N: 2 w₀ max (2/√3) σ_y(a) e^(−ε) with
  /// ε = (√3/2) a and the elastic part (Considère 1885, in plane strain).
  static double considereForce();
};
struct StripStep {
  double elongation;     ///< of the half length, m
  double force;          ///< on the whole section, 1 m thick, N
  double neckHalfWidth;  ///< m
};
struct StripResult {
  std::vector<StripStep> steps;
  std::int64_t iterations;
  int cuts;
  double seconds;
};
StripResult stretch(const NeckingStrip& strip);

/// Force over area and flow stress in a neck of radius a and curvature 1/R: (1 + 2R/a) ln(1 + a/2R)
/// (Bridgman 1952, Studies in Large Plastic Flow and Fracture).
double bridgmanFactor(double radius, double curvature);

}  // namespace dovetail::fem
