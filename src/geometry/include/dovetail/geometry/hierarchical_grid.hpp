// The hierarchical grid: contact candidates among spheres of widely different sizes in O(N) time and memory.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "dovetail/core/raw_vector.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::geometry {

namespace detail {
struct AxisCells;  // cells along one axis, in one part or, around a periodic border, in two
}

/// The periodic axes, with the period upper − lower of the box; the other axes of the box are ignored.
struct Periodicity {
  Box box;
  std::array<bool, 3> axes{false, false, false};

  friend bool operator==(const Periodicity&, const Periodicity&) = default;
  bool any() const { return axes[0] || axes[1] || axes[2]; }
  double length(int axis) const { return box.upper[axis] - box.lower[axis]; }
  /// The shortest periodic image of a separation d (m) of two points.
  Vec3 minimumImage(Vec3 d) const {
    for (int k = 0; k < 3; ++k)
      if (axes[static_cast<std::size_t>(k)]) d[k] -= length(k) * std::round(d[k] / length(k));
    return d;
  }
};

using SpherePairs = RawVector<std::array<int, 2>>;

/// Spheres sorted into levels by size and, within a level, into cells about as large as the level's largest sphere.
///
/// A sphere is looked up in its own level and in all coarser ones (Ogarko & Luding, Comput. Phys. Commun. 183, 2012;
/// Krijgsman, Ogarko & Luding, Comp. Part. Mech. 1, 2014); a box is looked up in every level (Cheng et al. 2022,
/// Algorithm 2). Cells exist only as keys by which the spheres are sorted, row by row, with an index of at most a few
/// entries per sphere into them: memory is O(N) whatever the extent of the cloud. Results are a function of the input
/// alone, for any number of threads.
class HierarchicalGrid {
public:
  HierarchicalGrid() = default;
  /// @throws InputError if a periodic axis has no finite positive length
  explicit HierarchicalGrid(const Periodicity& periodicity);

  /// Sorts the spheres in. Memory of earlier builds is reused.
  /// @param x      N centres, m; along periodic axes they may lie outside the box
  /// @param radius N radii, m
  /// @param skin   ≥ 0, m: every sphere counts as if its radius were radius + skin/2, here and in the searches below
  /// @throws InputError naming the particle whose position is not finite or whose radius is not finite and > 0;
  ///         if x and radius differ in length; if a periodic length is below twice the largest inflated diameter,
  ///         where a pair could meet through two images
  void build(std::span<const Vec3> x, std::span<const double> radius, double skin = 0.0);

  /// All pairs i < j with |xi − xj| ≤ hi + hj, h = radius + skin/2, through the nearest image; sorted by i, then j.
  SpherePairs pairs() const;

  /// Calls callback(i, j), i < j, once for each pair, in an order of the grid's own that depends on the input alone.
  template <class Callback>
  void forEachPair(Callback&& callback) const {
    using Stored = std::remove_reference_t<Callback>;
    searchPairs(
        0, size(),
        [](void* context, int i, const int* partners, std::size_t count) {
          for (std::size_t k = 0; k < count; ++k) {
            const int j = partners[k];
            (*static_cast<Stored*>(context))(i < j ? i : j, i < j ? j : i);
          }
        },
        const_cast<void*>(static_cast<const void*>(&callback)));
  }

  /// Calls callback(i) once for each sphere whose bounding box xi ± hi, or a periodic image of it, meets the box; the
  /// order is the grid's own and depends on the input alone.
  /// @throws InputError unless lower ≤ upper in every component
  template <class Callback>
  void query(const Box& box, Callback&& callback) const {
    using Stored = std::remove_reference_t<Callback>;
    searchBox(
        box, [](void* context, int i) { (*static_cast<Stored*>(context))(i); },
        const_cast<void*>(static_cast<const void*>(&callback)));
  }
  /// The same, ascending.
  std::vector<int> query(const Box& box) const;

  const Periodicity& periodicity() const { return periodicity_; }
  std::size_t size() const { return id_.size(); }
  std::size_t levels() const { return levels_.size(); }
  /// Edge of the cells of a level (0 = finest), m; along periodic axes the cells may be larger.
  double cellSize(std::size_t level) const { return levels_[level].size; }
  /// Sphere numbers in the order of the grid: near in this list means near in space.
  std::span<const int> order() const { return id_; }
  /// The spheres stay where they are under new numbers, one for each old number.
  void renumber(std::span<const int> newNumber);

private:
  using Key = std::uint64_t;
  using AxisCells = detail::AxisCells;
  /// Spheres [begin, end) in cells of one size. The key of cell (x, y, z) is (z ny + y) nx + x.
  struct Level {
    double size = 0.0, largest = 0.0;           // cell edge; largest inflated radius
    std::array<double, 3> origin{}, perCell{};  // lower corner; 1 / cell edge
    std::array<int, 3> count{1, 1, 1};          // cells along each axis
    std::size_t begin = 0, end = 0;             // in id_, key_, sphere_
    std::size_t index = 0, buckets = 0;         // in index_
    int shift = 0;                              // a bucket holds 2^shift successive keys
  };
  struct Keyed {
    Key key;
    int id;
  };
  struct Lookup;  // runs of spheres near a place in a level
  struct Search;  // scratch of one search
  using PairSink = void (*)(void* context, int i, const int* partners, std::size_t count);
  using BoxSink = void (*)(void* context, int i);

  struct Sizes {
    double smallest, largest;
  };
  Sizes checkSpheres(std::span<const Vec3> x, std::span<const double> radius, double skin) const;
  Vec3 wrapped(Vec3 x) const;
  void makeLevels(std::span<const Vec3> x, std::span<const double> radius, const Sizes& sizes);
  void addLevel(std::span<const int> members, std::size_t begin, double largest, std::span<const Vec3> x);
  void layCells(Level& level, std::span<const int> members, std::span<const Vec3> x) const;
  void sortLevel(Level& level, std::span<const int> members, std::span<const Vec3> x);
  void sortRange(const Level& level, std::span<const Keyed> members, std::size_t begin, std::size_t first,
                 std::size_t last);
  void sortBuckets(const Level& level, std::size_t first, std::size_t last, std::size_t stop);

  std::size_t firstFrom(const Level& level, Key key) const;
  AxisCells splitCells(const Level& level, std::size_t axis, int first, int last) const;
  AxisCells cellsAround(const Level& level, std::size_t axis, double centre, double reach) const;
  AxisCells cellsMeeting(const Level& level, int axis, double lower, double upper) const;
  void collectRuns(const Level& level, const std::array<AxisCells, 3>& cells, std::size_t after, Lookup& lookup) const;
  void lookUpOwnLevel(const Level& level, std::size_t s, Lookup& lookup) const;
  void lookUpCoarserLevel(const Level& level, std::size_t s, Lookup& lookup) const;
  template <bool periodic>
  void testRuns(std::size_t s, const Lookup& lookup, Search& search) const;
  template <bool periodic>
  void searchSpheres(std::size_t begin, std::size_t end, Search& search) const;
  void searchPairs(std::size_t begin, std::size_t end, PairSink sink, void* context) const;
  bool meets(std::size_t s, const Box& box) const;
  void searchLevel(const Level& level, const Box& box, BoxSink sink, void* context) const;
  void searchBox(const Box& box, BoxSink sink, void* context) const;

  Periodicity periodicity_;
  double skin_ = 0.0;
  std::vector<Level> levels_;                // finest first
  RawVector<int> id_;                        // sphere numbers, sorted by level, then key, then number
  RawVector<Key> key_;                       // cell of each sphere, in sorted order
  RawVector<std::array<double, 4>> sphere_;  // x, y, z (wrapped), inflated radius, in sorted order
  RawVector<int> index_;                     // per level and bucket of keys: its first sphere
};

}  // namespace dovetail::geometry
