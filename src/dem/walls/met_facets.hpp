// The facets near one particle, of one wall or of several.
#pragma once

#include <span>
#include <vector>

#include "facet_view.hpp"
#include "wall_sweep.hpp"

namespace dovetail::dem {

/// A wall as one particle meets it. All positions below are relative to the particle's centre.
struct MetWall {
  const Encounter& encounter;
  const TriangulatedWall* wall;
  WallContacts* contacts;  // where the particle's contacts with it go

  FacetCorners corners(std::size_t entry) const { return {*wall, encounter.facet[entry], encounter.seenFrom(entry)}; }
  void add(std::size_t entry, const FacetView& view, double overlap, double engagement, double energyFraction) const {
    addContact(*contacts, encounter, entry, view.weight, view.normal, overlap, engagement, energyFraction);
  }
};

struct MetFacet {
  const MetWall* met = nullptr;
  std::size_t entry = 0;  // of the encounter
  FacetView view;

  FacetCorners corners() const { return met->corners(entry); }
  bool is(const MetFacet& other) const { return met == other.met && entry == other.entry; }
};

/// A list that keeps its elements when it is emptied: those at its end are filled in place before they count.
class MetFacets {
public:
  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  /// The element behind the last one.
  MetFacet& next() {
    if (count_ == kept_.size()) kept_.emplace_back();
    return kept_[count_];
  }
  void keepNext() { ++count_; }
  const MetFacet& operator[](std::size_t i) const { return kept_[i]; }
  std::span<MetFacet> all() { return {kept_.data(), count_}; }
  std::span<const MetFacet> all() const { return {kept_.data(), count_}; }

private:
  std::vector<MetFacet> kept_;
  std::size_t count_ = 0;
};

/// EdgeRule::projected: appends the contacts of one particle to those of each wall.
/// @param walls not none; the same particle in all encounters
void projectParticle(std::span<const MetWall> walls);

}  // namespace dovetail::dem
