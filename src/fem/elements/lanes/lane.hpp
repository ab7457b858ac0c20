// Four elements side by side: the caches and the vector type of the force kernels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/laws/materials.hpp"

namespace dovetail::fem::detail {

inline constexpr int laneCount = 4;
inline constexpr std::size_t laneBytes = 8 * laneCount;
/// One double of each of four elements. Compilers without vector registers of this width split it,
/// and may align it to less: the structures below therefore state their alignment.
using Lane [[gnu::vector_size(laneBytes)]] = double;

// Watched code is not worth the minutes that inlining all of it takes.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DOVETAIL_INLINE inline
#else
#define DOVETAIL_INLINE [[gnu::always_inline]] inline
#endif

/// Aligned for wide registers, whatever a build for any processor thinks of Lane: what is handed to code for wide
/// registers lies in such arrays.
template <std::size_t size>
struct alignas(laneBytes) Lanes : std::array<Lane, size> {};

/// The same on the heap.
template <class T>
struct LaneAllocator {
  using value_type = T;
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{laneBytes}));
  }
  void deallocate(T* lanes, std::size_t) noexcept { ::operator delete (lanes, std::align_val_t{laneBytes}); }
  friend bool operator==(const LaneAllocator&, const LaneAllocator&) { return true; }
};
using LaneVector = std::vector<Lane, LaneAllocator<Lane>>;

/// Four consecutive elements. Corners in binary order: bit 0, 1, 2 of the corner set means +ξ, +η, +ζ.
/// A batch that is not full repeats its last element with zero weight.
struct Batch {
  std::array<std::array<std::int32_t, laneCount>, 8> node;
  std::int32_t count;     ///< elements in use
  std::int32_t geometry;  ///< place in BrickCache::boxes or ::general
  bool box;
};

/// Boxes along the axes: ∂ξ/∂X is diagonal and constant.
struct alignas(laneBytes) BoxGeometry {
  std::array<Lane, 3> gradientScale;  ///< ∂ξ_j/∂X_j / 8
  Lane weight;                        ///< det ∂X/∂ξ, m³
};

/// Any bricks: map[p] is ∂ξ/∂X at Gauss point p, row-major, or ∂ξ/∂X · J0 for hybrid8.
struct alignas(laneBytes) GeneralGeometry {
  std::array<std::array<Lane, 9>, 8> map;
  std::array<Lane, 8> weight;  ///< det ∂X/∂ξ, m³
  std::int32_t hybrid;         ///< place in BrickCache::hybrid
};

/// Bricks of hybrid8 that are no boxes.
struct alignas(laneBytes) HybridGeometry {
  std::array<Lane, 9> centreJacobian;  ///< J0 = ∂X/∂ξ at the centre, row-major, m
  std::array<Lane, 171> stiffness;     ///< H⁻¹, upper triangle by rows
};

enum class Law { stVenantKirchhoff, deformedMetric, axialSprings, hybrid };

/// What the laws need of λ, μ, E and ν, for strains 2E.
struct LawConstants {
  double halfLambda, mu;
  double halfYoung;  ///< E/2
  double halfPlane;  ///< E/(2(1 − ν²))
  double poisson;
};

/// ∂U/∂u of a batch, N: [component][corner], and its strain energy, J.
struct alignas(laneBytes) BatchForces {
  std::array<std::array<Lane, 8>, 3> f;
  Lane energy;  ///< only if asked for
};

/// det F of a batch at its Gauss points.
struct alignas(laneBytes) BatchDeterminants {
  std::array<Lane, 8> value;
};

/// What the kernels of a solid's batches read.
struct BrickCache {
  Law law;
  LawConstants constants;
  std::vector<Batch> batches;
  std::vector<BoxGeometry> boxes;
  std::vector<GeneralGeometry> general;
  std::vector<HybridGeometry> hybrid;
  std::size_t memory() const;
};

}  // namespace dovetail::fem::detail
