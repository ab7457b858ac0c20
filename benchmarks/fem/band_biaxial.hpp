// A solid that softens, pressed together between plates: with and without a width of its bands.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::benchmark {

/// 1 m × 2 m in plane strain at 100 kPa all round, quad8 with 2 × 2 points, or quad4. Explicit, the upper plate at 5 %
/// a second.
struct BandBiaxial {
  int across = 16;  ///< elements to the width, twice as many to the height
  fem::ElementShape shape = fem::ElementShape::quad8;
  double modulus = 0.0;    ///< D, N; 0: no gradient
  double skew = 0.0;       ///< of the mesh, fraction of an element
  double end = 0.04;       ///< mean axial strain
  double damping = 20.0;   ///< of the nodes, 1/s
  bool rough = false;      ///< plates hold what they touch; else it slides
  bool following = false;  ///< the pressure turns and stretches with the sides
};

/// A field of points and its elements.
struct BandPart {
  std::shared_ptr<fem::PointField> field;
  std::vector<int> elements{};  ///< empty: all
};

/// At 1 %, 2 % … of mean axial strain.
struct BandLook {
  double axial = 0.0;     ///< mean over 0.25 % before, Pa
  double fraction = 0.0;  ///< of the volume that holds half of the shear
  double largest = 0.0;   ///< shear of a point, |(F₁₁ − F₂₂, F₁₂ + F₂₁)|
};

struct BiaxialCourse {
  std::vector<BandLook> looks;
  double peak = 0.0;    ///< largest mean over 0.25 %, Pa
  double broken = 0.0;  ///< mean axial strain where an element turned inside out or brokenResidual was passed; 0: none
  double step = 0.0;    ///< s
  std::int64_t steps = 0;
  double seconds = 0.0;   ///< of the processor
  double residual = 0.0;  ///< of the ledger over the work of the plates
};

/// Of the ledger over the work: runs that lose more are broken off.
constexpr double brokenResidual = 0.01;

/// What the points of solids have of shear.
BandLook shearOf(const fem::Model& model);

BiaxialCourse pressTogether(const BandBiaxial& settings, const std::vector<BandPart>& parts);

}  // namespace dovetail::benchmark
