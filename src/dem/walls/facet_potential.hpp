// The potential of EdgeRule::projected where one facet does not say all: see projectWallContacts.
#pragma once

#include <span>
#include <vector>

#include "dovetail/dem/walls/edge_contact_solver.hpp"
#include "met_facets.hpp"

namespace dovetail::dem {

/// A facet that holds the particle off, seen from yᵢ.
struct ActiveFacet : MetFacet {
  Vec3 position;       // yᵢ − x
  bool plane = false;  // its normal is the face's, from wherever it is seen
};

/// Those that hold it off together.
struct ActiveSet {
  std::vector<ActiveFacet> facets;
  std::vector<Fraction> fractions;  // of each
  double energy = 0.0;              // V/k, m²
  bool complete = false;            // a minimum, and nobody else is met there
};

/// One particle among the facets that it touches.
class FacetPotential {
public:
  /// Memory that is kept between particles and steps.
  struct Scratch {
    ActiveSet set, kept, best;
    std::vector<MetFacet> refused;
    EdgeContactSolver solver;
  };

  /// @param near    all facets around, seen from the centre; those that touch first
  /// @param sunkIn  the centre lies inside a one-sided wall: facets are seen from where it comes out
  FacetPotential(double radius, std::span<const MetFacet> near, bool sunkIn, Scratch& scratch)
      : radius_(radius), near_(near), sunkIn_(sunkIn), scratch_(scratch) {
    scratch_.best.facets.clear();
    scratch_.best.complete = false;
  }

  /// Looks for the minimum from one facet on; scratch.best is the lower of what it was and what is found.
  /// @param atLeast m²: what is below leads nowhere
  void lower(const ActiveFacet& first, double atLeast = 0.0);
  /// The contacts of scratch.best.
  void append() const;

private:
  /// What is left of the overlap with a facet under the fractions of others, along the normal that leaves least.
  struct Remainder {
    double depth = 0.0;  // m
    ActiveFacet facet;
  };

  void descend(const ActiveFacet& first, bool other);
  enum class Slide { yes, offSet, no };  // to facets with nearer feet; but for those of the set; not at all

  bool holds(const MetFacet& facet) const;
  void see(ActiveFacet& facet, Slide slide = Slide::yes) const;
  void fraction();
  bool converge();
  double stepOn(double damping);
  void dropIdle();
  double remaining(const Vec3& normal, double support) const;
  Vec3 pushed(const Vec3& normal) const;
  bool follow(const MetFacet& facet, const Vec3& position, Remainder& found) const;
  bool clearedAlongFractions(const MetFacet& facet) const;
  bool leastRemainder(const MetFacet& facet, bool other, Remainder& least);
  bool takeIn(bool other);

  double radius_;
  std::span<const MetFacet> near_;
  bool sunkIn_;
  Scratch& scratch_;
  bool ambiguous_ = false;  // some facet had two normals that leave locally least
};

}  // namespace dovetail::dem
