// The surface of one solid, of which several couplings have a part.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dovetail/surface/coupling.hpp"

namespace dovetail::surface {

/// Faces with a law, a material and a kernel of their own.
struct SurfacePart {
  Coupling* coupling;
  const dem::ContactLaws* laws;
};

/// Finds the contacts with all parts at once, so that one place pushes once, also where parts meet in a plane or along
/// an edge; each part then answers those on its facets. What a contact remembers goes with it into a part with the same
/// law.
class SolidSurface {
public:
  /// @throws InputError if parts have a face in common, or combine contacts by different rules
  explicit SolidSurface(std::span<const SurfacePart> parts);

  /// As Coupling::exchange, for all parts, which are those it was made of or copies of them. Each has then its load().
  dem::ContactWork exchange(std::span<const SurfacePart> parts, dem::Particles& particles, std::span<const Vec3> u,
                            std::span<const Vec3> v, double dt, const ExchangeOptions& options);
  double renumber(std::span<const int> newNumber) { return whole_.renumber(newNumber); }
  double madeByShares() const { return whole_.madeByShares(); }
  const Coupling& whole() const { return whole_; }

  void save(ByteWriter& writer) const { whole_.save(writer); }
  void load(ByteReader& reader) { whole_.load(reader); }

private:
  int partOf(int facet) const;
  void handOver(std::span<const SurfacePart> parts);
  void handOver(std::span<const SurfacePart> parts, std::size_t begin, std::size_t end);
  void gatherEnergies(std::span<const SurfacePart> parts);

  Coupling whole_;
  std::vector<int> first_;  // facet of each part, and their number
  std::vector<int> alike_;  // per part: the first with the same law
};

}  // namespace dovetail::surface
