// Solids of cells under biaxial compression, which several figures press together.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/hierarchical/cell_field.hpp"

namespace dovetail::benchmark {

/// 400 discs with what Liang & Zhao 2019 are taken to have (r = 3–7 mm, E = 600 MPa, k_t/k_n = 0.8, φ = 0.5 rad), made
/// without friction, at rest to 1e-6 under 100 kPa all round.
rve::Rve sand(std::uint64_t seed, int discs = 400);

struct BiaxialOptions {
  std::array<int, 2> elements{1, 1};
  fem::ElementShape shape = fem::ElementShape::quad4;
  fem::Formulation formulation = fem::Formulation::standard;
  Vec3 size{1.0, 2.0, 1.0};  ///< width, height, thickness, m
  double pressure = 1e5;     ///< of the sides, Pa, follows them
  bool rough = false;        ///< plates hold what they touch; else it slides
  bool wall = true;          ///< the left side slides along a wall, or is pressed as the right one
  bool straight = false;     ///< the right side stays straight
};

/// A solid between two plates of which the upper one moves.
struct BiaxialSolid {
  fem::SolidMesh mesh;
  fem::Model model;
  std::shared_ptr<fem::Solid> solid;
  Vec3 size;

  /// @param sinks  way of the upper plate downwards, m, of time
  BiaxialSolid(const BiaxialOptions& settings, std::shared_ptr<fem::PointField> field, const fem::TimeFunction& sinks);

  /// Mean of −P₂₂ over the points, Pa.
  double axial();
  /// Load of the upper plate by the forces found last (nodes.f) over the width at the start, Pa.
  double plateStress() const;
};

/// A look at a solid that is pressed together.
struct Look {
  double strain = 0.0;           ///< mean, since the start
  double plate = 0.0;            ///< plateStress(), mean since the look before, Pa
  double stressRatio = 0.0;      ///< (σ₂₂ − σ₁₁)/(σ₂₂ + σ₁₁) of the means over the points
  double kineticFraction = 0.0;  ///< kinetic energy of the solid over the work done on it
};

/// Course of an explicit run.
struct Course {
  std::vector<Look> looks;  ///< at every 0.05 % of strain
  double residual = 0.0;    ///< largest of the ledger over the work in the end
  double seconds = 0.0;     ///< of the processor
  std::int64_t steps = 0;   ///< of the solid

  const Look& peak(double Look::*value) const;
  double mean(double Look::*value, double from, double to) const;
};

/// Presses a solid of moving cells together by explicit dynamics to a mean strain, at `rate` a second after a start
/// that takes 0.25 % of strain; nodes are damped by `damping`, 1/s (massDamping).
Course pressTogether(const BiaxialOptions& settings, const std::vector<rve::Rve>& samples, double rate, double damping,
                     double strain);

/// Seconds of the processor, of all threads.
double processorSeconds();

}  // namespace dovetail::benchmark
