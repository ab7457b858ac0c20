#include "dovetail/surface/coupling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "carried_points.hpp"
#include "carrier.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/walls/wall_archive.hpp"
#include "dovetail/dem/walls/wall_checks.hpp"
#include "packed.hpp"

namespace dovetail::surface {

std::vector<int> sortedUnique(std::vector<int> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

namespace {

/// Four at once of max |a − b|². A NaN stays in the sum.
struct LargestOfFour {
  Packed largest{}, sum{};

  /// a[0] − b[0] … a[3] − b[3]
  [[gnu::always_inline]] void meet(const std::array<const Vec3*, 4>& a, const Vec3* b) {
    const Packed x = Packed{a[0]->x, a[1]->x, a[2]->x, a[3]->x} - Packed{b[0].x, b[1].x, b[2].x, b[3].x},
                 y = Packed{a[0]->y, a[1]->y, a[2]->y, a[3]->y} - Packed{b[0].y, b[1].y, b[2].y, b[3].y},
                 z = Packed{a[0]->z, a[1]->z, a[2]->z, a[3]->z} - Packed{b[0].z, b[1].z, b[2].z, b[3].z};
    const Packed squared = x * x + y * y + z * z;
    largest = squared > largest ? squared : largest;
    sum += squared;
  }
  [[gnu::always_inline]] dem::Largest value() const {
    const double whole = sum[0] + sum[1] + sum[2] + sum[3];
    return {std::isnan(whole) ? whole : std::max(std::max(largest[0], largest[1]), std::max(largest[2], largest[3]))};
  }
};

/// Largest |now(i) − before[i]|, m; NaN if any place is NaN, so that a comparison with a margin fails.
/// @param now  of i: a reference to where it is
template <class Now>
double largestTravel(std::span<const Vec3> before, const Now& now) {
  return std::sqrt(parallelSum(before.size(), 4096, [&](std::size_t begin, std::size_t end) {
                     dem::Largest squared;
                     withVectors([&] {
                       LargestOfFour four;
                       std::size_t i = begin;
                       for (; i + 4 <= end; i += 4)
                         four.meet({&now(i), &now(i + 1), &now(i + 2), &now(i + 3)}, &before[i]);
                       squared = four.value();
                       for (; i < end; ++i) squared.meet(squaredNorm(now(i) - before[i]));
                     });
                     return squared;
                   }).value);
}

[[noreturn]] void refuseOther(const char* asked, const char* is) {
  throw InputError(std::string("it is on ") + is, "surface coupling", std::string("ask for ") + asked);
}

}  // namespace

Coupling::Coupling(Skin skin, const CouplingOptions& options)
    : carrier_(makeCarrier(std::move(skin), options.edges)),
      margin_(requireNonNegative(options.margin, "the candidate margin")),
      onPoints_(carrier_->points().size()),
      load_(static_cast<std::size_t>(carrier_->map().columns)),
      surfaceNodes_(sortedUnique(carrier_->map().column)),
      gain_(carrierGain(carrier_->map(), carrier_->turns())) {}

Coupling::Coupling(SmoothSurface surface, const CouplingOptions& options)
    : carrier_(makeCarrier(std::move(surface))),
      margin_(requireNonNegative(options.margin, "the candidate margin")),
      onPoints_(carrier_->points().size()),
      load_(static_cast<std::size_t>(carrier_->map().columns)),
      surfaceNodes_(sortedUnique(carrier_->map().column)),
      gain_(carrierGain(carrier_->map(), carrier_->turns())) {}

Coupling::~Coupling() = default;
Coupling::Coupling(Coupling&&) noexcept = default;
Coupling::Coupling(const Coupling&) = default;
Coupling& Coupling::operator=(const Coupling&) = default;
Coupling& Coupling::operator=(Coupling&&) noexcept = default;

Coupling::OwnCarrier::OwnCarrier(std::unique_ptr<Carrier> carrier) : carrier_(std::move(carrier)) {}
Coupling::OwnCarrier::~OwnCarrier() = default;
Coupling::OwnCarrier::OwnCarrier(const OwnCarrier& other) : carrier_(other.carrier_->clone()) {}
Coupling::OwnCarrier::OwnCarrier(OwnCarrier&&) noexcept = default;
Coupling::OwnCarrier& Coupling::OwnCarrier::operator=(OwnCarrier other) noexcept {
  carrier_.swap(other.carrier_);
  return *this;
}

dem::ContactWork Coupling::exchange(dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v,
                                    const dem::ContactLaws& laws, double dt, const ExchangeOptions& options) {
  locate(particles, u, v, laws.reach(), options);
  placeSurface(u, v);
  carrier_->findContacts(particles, travelled_, contacts_);
  const dem::ContactWork work = dem::sweepWall(options.timeless, contacts_.springs.left, [&] {
    return laws.wall(particles, carrier_->wall(), contacts_, dt, options.booking);
  });
  if (booksWork_ && uBefore_.empty()) uBefore_.assign(u.begin(), u.end());
  if (booksWork_) nodeWork_ += 0.5 * nodeWorkSinceLast(u);
  transfer();
  if (booksWork_) nodeWork_ += 0.5 * nodeWorkSinceLast(u);
  if (booksWork_) uBefore_.assign(u.begin(), u.end());
  return work;
}

double Coupling::nodeWorkSinceLast(std::span<const Vec3> u) const {
  double work = 0.0;
  for (const int node : load_.touched) work += dot(load_.force[node], u[node] - uBefore_[node]);
  return work;
}

void Coupling::locate(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v, double reach,
                      const ExchangeOptions& options) {
  if (!marginUsed(particles, u, reach, options)) return;
  requireFinite(particles.x, "particle", "position", "contact search with a surface");
  requireFinite(u, "node", "displacement", "contact search with a surface");
  carrier_->placeAll(u, v);
  marginAtBuild_ = margin_;
  if (margin_ == 0.0 && particles.size() > 0)
    marginAtBuild_ = 0.5 * *std::min_element(particles.radius.begin(), particles.radius.end());
  carrier_->search(particles, marginAtBuild_, reach, options.periodicity);
  ++builds_;
  travelled_ = 0.0;
  revision_ = particles.revision;
  reachAtBuild_ = reach;
  periodAtBuild_ = dem::periodsOf(options.periodicity);
  if (options.moves)
    travel_.reset(*options.moves);
  else
    particlesAtBuild_ = particles.x;
  nodesAtBuild_.clear();
  for (int node : surfaceNodes_) nodesAtBuild_.push_back(u[node]);
}

// Comparisons are written so that a NaN asks for a search, which then names the culprit.
bool Coupling::marginUsed(const dem::Particles& particles, std::span<const Vec3> u, double reach,
                          const ExchangeOptions& options) {
  if (builds_ == 0 || particles.revision != revision_ || reach != reachAtBuild_ ||
      !(dem::periodsOf(options.periodicity) == periodAtBuild_))
    return true;
  if (options.moves)
    travel_.add(*options.moves);
  else if (particlesAtBuild_.size() != particles.size())
    return true;
  const double ofParticles =
      options.moves ? travel_.bound
                    : largestTravel(particlesAtBuild_, [&](std::size_t i) -> const Vec3& { return particles.x[i]; });
  const double ofNodes =
      largestTravel(nodesAtBuild_, [&](std::size_t k) -> const Vec3& { return u[surfaceNodes_[k]]; });
  travelled_ = ofParticles + gain_ * ofNodes;
  return !(travelled_ <= marginAtBuild_);
}

void Coupling::placeSurface(std::span<const Vec3> u, std::span<const Vec3> v) {
  if (!booksWork_) return carrier_->place(u, v);
  carrier_->placeAll(u, v);
  const auto now = carrier_->points();
  if (previous_.empty()) previous_.assign(now.begin(), now.end());
  wallWork_ += 0.5 * workSinceLast();
}

void Coupling::transfer() {
  onPoints_.clear();
  carrier_->addReaction(contacts_, onPoints_);
  if (booksWork_) {
    wallWork_ += 0.5 * workSinceLast();
    previous_.assign(carrier_->points().begin(), carrier_->points().end());
  }
  load_.clear();
  if (!spread_) return addLoadOfPoints(carrier_->map(), carrier_->turns(), onPoints_, load_);
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    spread_->add(skin(), contacts_.facet[c], contacts_.weight[c], contacts_.force[c], load_);
}

double Coupling::workSinceLast() const {
  double work = 0.0;
  for (int point : onPoints_.touched) work += dot(onPoints_.force[point], carrier_->points()[point] - previous_[point]);
  return work;
}

void Coupling::check(const dem::ContactLaws& laws, const geometry::Periodicity& periodicity) const {
  carrier_->check(laws, periodicity);
}

void Coupling::check(const dem::Particles& particles, int materials) const {
  dem::requireRows(contacts_, {particles.size(), carrier_->wall().facets.size(), materials},
                   revision_ == particles.revision);
}

double Coupling::renumber(std::span<const int> newNumber, const dem::Particles& before) {
  return dem::renumber(contacts_, newNumber, before);
}

const Skin& Coupling::skin() const {
  if (!carrier_->skin()) refuseOther("smoothSurface()", "smooth patches");
  return *carrier_->skin();
}
const SmoothSurface& Coupling::smoothSurface() const {
  if (!carrier_->smooth()) refuseOther("skin()", "facets");
  return *carrier_->smooth();
}
const dem::TriangulatedWall& Coupling::wall() const { return carrier_->wall(); }
const dem::TriangulatedWall& Coupling::outline(std::span<const Vec3> u, std::span<const Vec3> v) {
  carrier_->placeAll(u, v);
  return carrier_->outline();
}
int Coupling::nodeCount() const { return carrier_->map().columns; }

template <class Archive, class Self>
void Coupling::archive(Archive& archive, Self& self) {
  dem::archiveContacts(archive, self.contacts_);
  archive(self.builds_, self.revision_, self.marginAtBuild_, self.reachAtBuild_, self.periodAtBuild_,
          self.particlesAtBuild_, self.nodesAtBuild_, self.travel_, self.booksWork_, self.wallWork_, self.nodeWork_,
          self.previous_, self.uBefore_);
}

void Coupling::save(ByteWriter& writer) const {
  archive(writer, *this);
  carrier_->save(writer);
}

void Coupling::load(ByteReader& reader) {
  archive(reader, *this);
  carrier_->load(reader);
  const auto refuse = [] {
    throw InputError("lists of a state do not fit each other", "contacts on a surface", "take an older checkpoint");
  };
  if ((booksWork_ || !previous_.empty()) && previous_.size() != carrier_->points().size()) refuse();
  dem::requireWhole(contacts_);
  for (const int facet : contacts_.facet)
    if (facet < 0 || static_cast<std::size_t>(facet) >= carrier_->wall().facets.size()) refuse();
  if (builds_ != 0 && nodesAtBuild_.size() != surfaceNodes_.size()) refuse();
  if (!uBefore_.empty() && uBefore_.size() != static_cast<std::size_t>(nodeCount())) refuse();
  transfer();
}

}  // namespace dovetail::surface
