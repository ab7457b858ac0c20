// Contacts with the facets of a skin, as with any triangulated wall.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "carried_points.hpp"
#include "carrier.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/walls/facet_spin.hpp"
#include "dovetail/dem/walls/wall_archive.hpp"
#include "dovetail/dem/walls/wall_clearances.hpp"

namespace dovetail::surface {

namespace {

/// Of what is 1 at one vertex of a facet on the facet's spin, 1/m.
std::array<double, 3> spinRates(const dem::TriangulatedWall& wall, const geometry::Facet& facet) {
  const dem::FacetSpin spin(wall.x[facet[0]], wall.x[facet[1]], wall.x[facet[2]]);
  std::array<double, 3> squared{};
  for (const Vec3& couple : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    const auto force = spin.forces(couple);
    for (std::size_t k = 0; k < 3; ++k) squared[k] += squaredNorm(force[k]);
  }
  return {std::sqrt(squared[0]), std::sqrt(squared[1]), std::sqrt(squared[2])};
}

class FlatCarrier final : public Carrier {
public:
  FlatCarrier(Skin skin, dem::EdgeRule rule) : skin_(std::move(skin)), rule_(rule) {}

  std::unique_ptr<Carrier> clone() const override { return std::make_unique<FlatCarrier>(*this); }
  const cg::Projection& map() const override { return skin_.carrier; }
  const PatchOffsets& offsets() const override { return skin_.offsets; }
  std::span<const Vec3> points() const override { return skin_.wall.x; }
  const Skin* skin() const override { return &skin_; }
  void check(const dem::ContactLaws&, const geometry::Periodicity&) const override {}

  void placeAll(std::span<const Vec3> u, std::span<const Vec3> v) override { surface::place(skin_, u, v); }
  void place(std::span<const Vec3> u, std::span<const Vec3> v) override { surface::place(skin_, u, v, active_); }

  void activate(const dem::WallContacts& contacts) override { activate(contacts.facet); }

  void search(const dem::Particles& particles, double margin, double reach,
              const geometry::Periodicity& periodicity) override {
    candidates_.reach = reach;
    dem::findWallCandidates(particles, skin_.wall, margin, candidates_, periodicity);
    clearances_ = dem::clearancesNow(particles, skin_.wall, candidates_);
    activate(candidates_.facet);
  }
  void findContacts(const dem::Particles& particles, double travelled, dem::WallContacts& contacts) override {
    if (!candidates_.particle.empty() && static_cast<std::size_t>(candidates_.particle.back()) >= particles.size())
      refuse("a particle that does not exist");
    clearances_.travelled = travelled;
    dem::findWallContacts(particles, skin_.wall, candidates_, clearances_, rule_, contacts);
  }

  void addSeam(dem::WallContacts& contacts, const dem::WallAnswer& answer, std::span<const std::uint8_t> absent,
               std::vector<dem::WallAtSeam>& seams) const override {
    if (rule_ == dem::EdgeRule::projected)
      seams.push_back({&skin_.wall, &candidates_, &contacts, answer, &clearances_, absent});
  }

  const dem::TriangulatedWall& wall() const override { return skin_.wall; }
  const dem::TriangulatedWall& outline() override { return skin_.wall; }
  void addReaction(const dem::WallContacts& contacts, coupling::NodalLoad& onPoints) const override {
    for (int facet : contacts.facet)
      for (int vertex : skin_.wall.facets[facet]) onPoints.add(vertex, {});
    dem::addWallForces(contacts, skin_.wall.x, skin_.wall.facets, onPoints.force);
  }
  void follow(const dem::WallContacts& contacts, std::size_t contact,
              std::vector<std::pair<int, double>>& points) const override {
    const geometry::Facet& facet = skin_.wall.facets[contacts.facet[contact]];
    for (std::size_t k = 0; k < 3; ++k) points.emplace_back(facet[k], std::abs(contacts.weight[contact][k]));
  }
  void turnWith(const dem::WallContacts& contacts, std::size_t contact,
                std::vector<std::pair<int, double>>& points) const override {
    const geometry::Facet& facet = skin_.wall.facets[contacts.facet[contact]];
    const std::array<double, 3> rates = spinRates(skin_.wall, facet);
    for (std::size_t k = 0; k < 3; ++k) points.emplace_back(facet[k], rates[k]);
  }

  void carry(std::vector<Vec3> X, cg::Projection map) override {
    skin_.X = std::move(X);
    skin_.localMap = std::move(map);
    skin_.carrier = skin_.localMap;
  }

  void save(ByteWriter& writer) const override {
    dem::archiveCandidates(writer, candidates_);
    writer(clearances_.whenListed, skin_.wall.x, skin_.wall.v);
  }
  void load(ByteReader& reader) override {
    dem::archiveCandidates(reader, candidates_);
    const std::size_t points = skin_.wall.x.size();
    reader(clearances_.whenListed, skin_.wall.x, skin_.wall.v);
    if (skin_.wall.x.size() != points) refuse("another number of points");
    requireWhole();
    activate(candidates_.facet);
  }

private:
  [[noreturn]] static void refuse(const char* what) {
    throw InputError(std::string("a state has ").append(what), "contacts on a surface", "take an older checkpoint");
  }
  /// What a damaged state may not be.
  void requireWhole() const {
    const dem::WallCandidates& c = candidates_;
    const auto ascend = [](const std::vector<int>& list) {
      return std::is_sorted(list.begin(), list.end()) && (list.empty() || list.front() >= 0);
    };
    const bool ends = c.offsets.empty() ? c.facet.empty() && c.particle.empty()
                                        : c.offsets.size() == c.particle.size() + 1 && c.offsets.front() == 0 &&
                                              static_cast<std::size_t>(c.offsets.back()) == c.facet.size();
    if (!ends || !ascend(c.offsets) || !ascend(c.particle)) refuse("lists that do not fit each other");
    if (clearances_.whenListed.size() != c.facet.size()) refuse("lists that do not fit each other");
    for (const int facet : c.facet)
      if (facet < 0 || static_cast<std::size_t>(facet) >= skin_.wall.facets.size())
        refuse("a facet that does not exist");
    if (skin_.wall.x.size() != skin_.wall.v.size()) refuse("lists that do not fit each other");
  }
  void activate(const std::vector<int>& facets) {
    active_.clear();
    for (int facet : facets)
      active_.insert(active_.end(), skin_.wall.facets[facet].begin(), skin_.wall.facets[facet].end());
    active_ = sortedUnique(std::move(active_));
  }

  Skin skin_;
  dem::EdgeRule rule_;
  dem::WallCandidates candidates_;
  dem::WallClearances clearances_;
  std::vector<int> active_;  // vertices of candidate facets
};

}  // namespace

void Carrier::carry(std::vector<Vec3>, cg::Projection) {
  throw InputError("smooth patches keep their nodes", "contacts on a surface", "take facets");
}

std::unique_ptr<Carrier> makeCarrier(Skin skin, dem::EdgeRule rule) {
  return std::make_unique<FlatCarrier>(std::move(skin), rule);
}

}  // namespace dovetail::surface
