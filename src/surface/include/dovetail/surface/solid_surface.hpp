// The surface of one solid, of which several couplings have a part.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dovetail/surface/surface_coupler.hpp"

namespace dovetail::surface {

/// Faces with a law, a material and a kernel of their own.
struct SurfacePart {
  SurfaceCoupler* coupling;
  const dem::ContactLaws* laws;

  dem::WallAnswer answer() const { return {laws, coupling->wall().material}; }
};

/// Finds the contacts with all parts at once, so that each place has one contact, also where parts join in a plane or
/// along an edge; each part then computes those on its facets.
class SolidSurface {
public:
  /// @throws InputError if parts have a face in common, or combine contacts by different rules
  explicit SolidSurface(std::span<const SurfacePart> parts);

  /// As SurfaceCoupler's, for all parts, which are those it was made of or copies of them. Each has then its load().
  void find(std::span<const SurfacePart> parts, const dem::Particles& particles, std::span<const Vec3> u,
            std::span<const Vec3> v, const ExchangeOptions& options);
  /// Nothing if parts answer differently: what meets one of them at a seam meets the others too.
  void addSeam(std::span<const SurfacePart> parts, const ExchangeOptions& options, std::vector<dem::WallAtSeam>& seams);
  /// Weights the contacts, and distributes them to the parts.
  void handOut(std::span<const SurfacePart> parts, const dem::Particles& particles, std::span<const Vec3> u,
               std::span<const Vec3> v, const ExchangeOptions& options);
  dem::ContactWork answer(std::span<const SurfacePart> parts, dem::Particles& particles, std::span<const Vec3> u,
                          double dt, const ExchangeOptions& options);
  double renumber(std::span<const int> newNumber) { return whole_.renumber(newNumber); }
  double madeByWeights() const { return whole_.madeByWeights(); }
  const SurfaceCoupler& whole() const { return whole_; }

  void save(ByteWriter& writer) const { whole_.save(writer); }
  void load(ByteReader& reader) { whole_.load(reader); }

private:
  void gatherEnergies(std::span<const SurfacePart> parts);

  SurfaceCoupler whole_;
  std::vector<int> first_;  // facet of each part
  bool alike_ = true;       // whether all parts answer in the same way
};

}  // namespace dovetail::surface
