// Four elements side by side: the caches and the vector type of the force kernels.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/materials.hpp"

namespace dovetail::fem::detail {

inline constexpr int laneCount = 4;
/// One double of each of four elements. Compilers without vector registers of this width split it.
using Lane [[gnu::vector_size(8 * laneCount)]] = double;

#define DOVETAIL_INLINE [[gnu::always_inline]] inline

// A build for any x86-64 machine holds the kernels twice, and the loader takes the one with wide registers where there are
// any. The digits are the same unless DOVETAIL_FP_CONTRACT is on. Sanitizers cannot follow such functions.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define DOVETAIL_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DOVETAIL_SANITIZED
#endif
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__AVX2__) && !defined(DOVETAIL_SANITIZED)
#define DOVETAIL_KERNEL [[gnu::target_clones("arch=haswell", "default")]]
#else
#define DOVETAIL_KERNEL
#endif

DOVETAIL_INLINE Lane splat(double value) { return Lane{value, value, value, value}; }

/// Four consecutive elements. Corners in binary order: bit 0, 1, 2 of the corner set means +ξ, +η, +ζ.
/// A batch that is not full repeats its last element with zero weight.
struct Batch {
  std::array<std::array<std::int32_t, laneCount>, 8> node;
  std::int32_t count;     ///< elements in use
  std::int32_t geometry;  ///< place in ElementCache::boxes or ::general
  bool box;
};

/// Boxes along the axes: ∂ξ/∂X is diagonal and constant.
struct BoxGeometry {
  std::array<Lane, 3> gradientScale;  ///< ∂ξ_j/∂X_j / 8
  Lane weight;                        ///< det ∂X/∂ξ, m³
};

/// Any bricks: map[p] is ∂ξ/∂X at Gauss point p, row-major, or ∂ξ/∂X · J0 for hybrid8.
struct GeneralGeometry {
  std::array<std::array<Lane, 9>, 8> map;
  std::array<Lane, 8> weight;  ///< det ∂X/∂ξ, m³
  std::int32_t hybrid;         ///< place in ElementCache::hybrid
};

/// Bricks of hybrid8 that are no boxes.
struct HybridGeometry {
  std::array<Lane, 9> centreJacobian;  ///< J0 = ∂X/∂ξ at the centre, row-major, m
  std::array<Lane, 171> stiffness;     ///< H⁻¹, upper triangle by rows
};

enum class Law { stVenantKirchhoff, deformedMetric, hybrid };

/// What the laws need of λ, μ, E and ν, for strains 2E.
struct LawConstants {
  double halfLambda, mu;
  double halfYoung;  ///< E/2
  double halfPlane;  ///< E/(2(1 − ν²))
  double poisson;
};

/// ∂U/∂u of a batch, N: [component][corner].
struct BatchForces {
  std::array<std::array<Lane, 8>, 3> f;
};

struct ElementCache {
  Law law;
  LawConstants constants;
  std::vector<std::array<int, 8>> elements;
  std::vector<Vec3> X;
  std::vector<Batch> batches;
  std::vector<BoxGeometry> boxes;
  std::vector<GeneralGeometry> general;
  std::vector<HybridGeometry> hybrid;
  std::size_t boxElements = 0;
  // Several threads write to `forces`; then every node adds its own entries, in the order of the elements.
  std::vector<BatchForces> forces;
  std::vector<std::uint32_t> nodeOffsets;
  std::vector<std::uint32_t> nodeEntries;  ///< 32 batch + 4 corner + lane
};

}  // namespace dovetail::fem::detail
