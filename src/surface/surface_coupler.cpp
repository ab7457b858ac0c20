#include "dovetail/surface/surface_coupler.hpp"

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

/// As numbers of a list do.
bool ascends(const std::vector<int>& numbers) {
  return std::ranges::is_sorted(numbers) && (numbers.empty() || numbers.front() >= 0);
}

[[noreturn]] void refuseOther(const char* asked, const char* is) {
  throw InputError(std::string("it is on ") + is, "surface coupling", std::string("call ") + asked);
}

}  // namespace

SurfaceCoupler::SurfaceCoupler(Skin skin, const CouplingOptions& options)
    : carrier_(makeCarrier(std::move(skin), options.edges)),
      options_{options.edges, requireNonNegative(options.margin, "the candidate margin")},
      onPoints_(carrier_->points().size()),
      load_(static_cast<std::size_t>(carrier_->map().columns)),
      surfaceNodes_(sortedUnique(carrier_->map().column)),
      gain_(carrierGain(carrier_->map(), carrier_->offsets())) {}

SurfaceCoupler::SurfaceCoupler(SmoothSurface surface, const CouplingOptions& options)
    : carrier_(makeCarrier(std::move(surface))),
      options_{options.edges, requireNonNegative(options.margin, "the candidate margin")},
      onPoints_(carrier_->points().size()),
      load_(static_cast<std::size_t>(carrier_->map().columns)),
      surfaceNodes_(sortedUnique(carrier_->map().column)),
      gain_(carrierGain(carrier_->map(), carrier_->offsets())) {}

SurfaceCoupler::~SurfaceCoupler() = default;
SurfaceCoupler::SurfaceCoupler(SurfaceCoupler&&) noexcept = default;
SurfaceCoupler::SurfaceCoupler(const SurfaceCoupler&) = default;
SurfaceCoupler& SurfaceCoupler::operator=(const SurfaceCoupler&) = default;
SurfaceCoupler& SurfaceCoupler::operator=(SurfaceCoupler&&) noexcept = default;

SurfaceCoupler::OwnCarrier::OwnCarrier(std::unique_ptr<Carrier> carrier) : carrier_(std::move(carrier)) {}
SurfaceCoupler::OwnCarrier::~OwnCarrier() = default;
SurfaceCoupler::OwnCarrier::OwnCarrier(const OwnCarrier& other) : carrier_(other.carrier_->clone()) {}
SurfaceCoupler::OwnCarrier::OwnCarrier(OwnCarrier&&) noexcept = default;
SurfaceCoupler::OwnCarrier& SurfaceCoupler::OwnCarrier::operator=(OwnCarrier other) noexcept {
  carrier_.swap(other.carrier_);
  return *this;
}

void SurfaceCoupler::carry(std::vector<Vec3> X, cg::Projection map) {
  if (hasKernel(skin()) || map.rows() != carrier_->map().rows() || X.size() != carrier_->points().size())
    throw InputError("its surface has a kernel, or other vertices", "surface coupling", "give each vertex a row");
  carrier_->carry(std::move(X), std::move(map));
  load_ = coupling::NodalLoad(static_cast<std::size_t>(carrier_->map().columns));
  surfaceNodes_ = sortedUnique(carrier_->map().column);
  gain_ = carrierGain(carrier_->map(), carrier_->offsets());
  uBefore_.clear();
  changesNodes_ = true;
}

dem::ContactWork SurfaceCoupler::exchange(dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v,
                                          const dem::ContactLaws& laws, double dt, const ExchangeOptions& options) {
  find(particles, u, v, laws.reach(), options);
  weigh(particles, options);
  const dem::ContactWork work = answer(particles, u, laws, dt, options);
  bookWeights(options);
  return work;
}

void SurfaceCoupler::find(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v,
                          double reach, const ExchangeOptions& options) {
  if (particles.revision != revision_) sunk_.clear();
  locate(particles, u, v, reach, options);
  placeSurface(u, v);
  carrier_->findContacts(particles, travelled_, contacts_);
  if (carrier_->wall().oneSided) requireNoneThrough(particles, options.tied);
}

void SurfaceCoupler::addSeam(const dem::WallAnswer& answer, const ExchangeOptions& options,
                             std::vector<dem::WallAtSeam>& seams) {
  carrier_->addSeam(contacts_, answer, options.tied, seams);
}

dem::ContactWork SurfaceCoupler::answer(dem::Particles& particles, std::span<const Vec3> u,
                                        const dem::ContactLaws& laws, double dt, const ExchangeOptions& options) {
  const dem::ContactWork work = laws.wall(particles, carrier_->wall(), contacts_, dt, options.booking);
  if (booksWork_ && uBefore_.empty()) uBefore_.assign(u.begin(), u.end());
  if (booksWork_) nodeWork_ += 0.5 * nodeWorkSinceLast(u);
  transfer();
  if (booksWork_) nodeWork_ += 0.5 * nodeWorkSinceLast(u);
  if (booksWork_) uBefore_.assign(u.begin(), u.end());
  return work;
}

/// A face pushes centres out down to a radius below it. They get there in small steps: who was inside and is not pushed
/// any more has come through.
void SurfaceCoupler::requireNoneThrough(const dem::Particles& particles, std::span<const std::uint8_t> tied) {
  const auto touches = [&](int i) { return std::ranges::binary_search(contacts_.particle, i); };
  const auto isTied = [&](int i) { return !tied.empty() && tied[static_cast<std::size_t>(i)] != 0; };
  for (const int i : sunk_) {
    if (touches(i) || isTied(i)) continue;
    const auto at = static_cast<std::size_t>(i);
    throw NumericalError("it has sunk deeper into a closed surface than its radius, where no contact force acts on it",
                         "particle " + std::to_string(particles.id.empty() ? i : particles.id[at]),
                         "take a smaller step, a stiffer contact or a slower start");
  }
  sunk_.clear();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const int i = contacts_.particle[c];
    if (contacts_.overlap[c] > contacts_.engagement[c] * particles.radius[static_cast<std::size_t>(i)] && !isTied(i) &&
        (sunk_.empty() || sunk_.back() != i))
      sunk_.push_back(i);
  }
}

double SurfaceCoupler::fractionAt(std::size_t contact, std::span<const double> fraction) const {
  const cg::Projection& map = carrier_->skin() ? carrier_->skin()->localMap : carrier_->map();
  std::vector<std::pair<int, double>> points;
  carrier_->follow(contacts_, contact, points);
  double sum = 0.0;
  for (const auto& [point, weight] : points)
    for (std::size_t n = 0; n < map.rowColumns(point).size(); ++n)
      sum += weight * map.rowWeights(point)[n] * fraction[static_cast<std::size_t>(map.rowColumns(point)[n])];
  return std::clamp(sum, 0.0, 1.0);
}

/// Contacts get the fraction of the solid; those of tied particles go.
void SurfaceCoupler::weigh(const dem::Particles& particles, const ExchangeOptions& options) {
  if (options.fraction.empty()) return;
  dem::WallContacts& all = contacts_;
  fractions_.begin();
  std::size_t kept = 0;
  for (std::size_t c = 0; c < all.size(); ++c) {
    const auto i = static_cast<std::size_t>(all.particle[c]);
    const bool tied = !options.tied.empty() && options.tied[i] != 0;
    const double fraction = !tied                               ? fractionAt(c, options.fraction)
                            : fractions_.acted(all.particle[c]) ? ContactFractions::faded
                                                                : 0.0;
    fractions_.add(all.particle[c], particles.weightOf(i), std::abs(all.overlap[c]), fraction);
    if (!(fraction > 0.0)) continue;
    dem::forArrays(all, all, [&](auto& to, const auto& from) {
      if (!from.empty()) to[kept] = from[c];
    });
    for (std::vector<double>* const part : {&all.overlap, &all.engagement, &all.energyFraction})
      (*part)[kept] *= fraction;
    ++kept;
  }
  dem::resize(all, kept);
}

void SurfaceCoupler::bookWeights(const ExchangeOptions& options) {
  if (!options.fraction.empty()) fractions_.book(contacts_.particle, contacts_.energy);
}

double SurfaceCoupler::nodeWorkSinceLast(std::span<const Vec3> u) const {
  double work = 0.0;
  for (const int node : load_.touched) work += dot(load_.force[node], u[node] - uBefore_[node]);
  return work;
}

void SurfaceCoupler::locate(const dem::Particles& particles, std::span<const Vec3> u, std::span<const Vec3> v,
                            double reach, const ExchangeOptions& options) {
  if (!marginUsed(particles, u, reach, options)) return;
  requireFinite(particles.x, "particle", "position", "contact search with a surface");
  requireFinite(u, "node", "displacement", "contact search with a surface");
  carrier_->placeAll(u, v);
  marginAtBuild_ = options_.margin;
  if (options_.margin == 0.0 && particles.size() > 0)
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
bool SurfaceCoupler::marginUsed(const dem::Particles& particles, std::span<const Vec3> u, double reach,
                                const ExchangeOptions& options) {
  if (builds_ == 0 || nodesAtBuild_.size() != surfaceNodes_.size() || particles.revision != revision_ ||
      reach != reachAtBuild_ || !(dem::periodsOf(options.periodicity) == periodAtBuild_))
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

void SurfaceCoupler::placeSurface(std::span<const Vec3> u, std::span<const Vec3> v) {
  if (!booksWork_) return carrier_->place(u, v);
  carrier_->placeAll(u, v);
  const auto now = carrier_->points();
  if (previous_.empty()) previous_.assign(now.begin(), now.end());
  wallWork_ += 0.5 * workSinceLast();
}

void SurfaceCoupler::transfer() {
  onPoints_.clear();
  carrier_->addReaction(contacts_, onPoints_);
  if (booksWork_) {
    wallWork_ += 0.5 * workSinceLast();
    previous_.assign(carrier_->points().begin(), carrier_->points().end());
  }
  load_.clear();
  if (!spread_) return addLoadOfPoints(carrier_->map(), carrier_->offsets(), onPoints_, load_);
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    spread_->add(skin(), contacts_.facet[c], contacts_.weight[c], contacts_.force[c], load_);
}

double SurfaceCoupler::workSinceLast() const {
  double work = 0.0;
  for (int point : onPoints_.touched) work += dot(onPoints_.force[point], carrier_->points()[point] - previous_[point]);
  return work;
}

/// Of their skins, or control points: where nodes at rest have them.
void SurfaceCoupler::requireFits(std::span<const Vec3> X) const {
  const std::vector<Vec3>& points = carrier_->skin() ? carrier_->skin()->X : carrier_->smooth()->X;
  const cg::Projection& map = carrier_->skin() ? carrier_->skin()->localMap : carrier_->map();
  const bool keepsPlaces = carrier_->skin() || carrier_->offsets().empty();
  const bool isPlane = std::ranges::all_of(X, [&](const Vec3& x) { return x.z == X[0].z; });
  double size = 0.0, worst = 0.0;
  for (std::size_t p = 0; p < points.size() && keepsPlaces; ++p) {
    Vec3 off = points[p];
    const int row = static_cast<int>(p);
    for (std::size_t n = 0; n < map.rowColumns(row).size(); ++n)
      off -= map.rowWeights(row)[n] * X[static_cast<std::size_t>(map.rowColumns(row)[n])];
    if (isPlane) off.z = 0.0;  // strips lie on both sides of the plane
    worst = std::max(worst, norm(off));
    size = std::max(size, norm(points[p] - points[0]));
  }
  if (!(worst <= 1e-6 * size))
    throw InputError("its surface is up to " + formatNumber(worst) + " m off the nodes of the solid",
                     "surface coupling", "make the skin from the nodes of the solid it is to be on");
}

void SurfaceCoupler::check(const dem::ContactLaws& laws, const geometry::Periodicity& periodicity) const {
  carrier_->check(laws, periodicity);
}

void SurfaceCoupler::check(const dem::Particles& particles) const {
  const auto count = static_cast<int>(particles.size());
  if ((revision_ == particles.revision && !sunk_.empty() && sunk_.back() >= count) ||
      (!fractions_.now.particle.empty() && fractions_.now.particle.back() >= count))
    throw InputError("a state has a particle that does not exist", "contacts on a surface", "take an older checkpoint");
  dem::requireRows(contacts_, {particles.size(), carrier_->wall().facets.size()}, revision_ == particles.revision);
}

double SurfaceCoupler::renumber(std::span<const int> newNumber) {
  fractions_.renumber(newNumber);
  return dem::renumber(contacts_, newNumber);
}

bool SurfaceCoupler::meets(const SurfaceCoupler& other) const {
  return std::ranges::any_of(surfaceNodes_,
                             [&](int node) { return std::ranges::binary_search(other.surfaceNodes_, node); });
}

bool SurfaceCoupler::onFacets() const { return carrier_->skin() != nullptr; }

const Skin& SurfaceCoupler::skin() const {
  if (!carrier_->skin()) refuseOther("smoothSurface()", "smooth patches");
  return *carrier_->skin();
}
const SmoothSurface& SurfaceCoupler::smoothSurface() const {
  if (!carrier_->smooth()) refuseOther("skin()", "facets");
  return *carrier_->smooth();
}
const dem::TriangulatedWall& SurfaceCoupler::wall() const { return carrier_->wall(); }
const dem::TriangulatedWall& SurfaceCoupler::outline(std::span<const Vec3> u, std::span<const Vec3> v) {
  carrier_->placeAll(u, v);
  return carrier_->outline();
}
int SurfaceCoupler::nodeCount() const { return carrier_->map().columns; }

/// Contacts of a part, whose facets begin with number `first` of the whole.
void SurfaceCoupler::take(const SurfaceCoupler& whole, int first, double reach, std::span<const Vec3> u,
                          std::span<const Vec3> v) {
  const dem::WallContacts& all = whole.contacts_;
  const int end = first + static_cast<int>(carrier_->wall().facets.size());
  dem::clear(contacts_);
  contacts_.image.clear();
  contacts_.period = all.period;
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (all.facet[c] < first || all.facet[c] >= end || !(all.overlap[c] > -reach)) continue;
    dem::appendContact(contacts_, all, c);
    contacts_.facet.back() -= first;
  }
  contacts_.force.assign(contacts_.size(), Vec3{});
  revision_ = whole.revision_;
  carrier_->activate(contacts_);
  placeSurface(u, v);
}

template <class Archive, class Self>
void SurfaceCoupler::archive(Archive& archive, Self& self) {
  dem::archiveContacts(archive, self.contacts_);
  ContactFractions::archive(archive, self.fractions_);
  archive(self.sunk_);
  archive(self.builds_, self.revision_, self.marginAtBuild_, self.reachAtBuild_, self.periodAtBuild_,
          self.particlesAtBuild_, self.nodesAtBuild_, self.travel_, self.booksWork_, self.wallWork_, self.nodeWork_,
          self.previous_, self.uBefore_);
}

void SurfaceCoupler::save(ByteWriter& writer) const {
  archive(writer, *this);
  carrier_->save(writer);
}

void SurfaceCoupler::load(ByteReader& reader) {
  archive(reader, *this);
  carrier_->load(reader);
  const auto refuse = [] {
    throw InputError("lists of a state do not fit each other", "contacts on a surface", "take an older checkpoint");
  };
  if (!fractions_.isWhole() || !ascends(sunk_)) refuse();
  if ((booksWork_ || !previous_.empty()) && previous_.size() != carrier_->points().size()) refuse();
  dem::requireWhole(contacts_);
  for (const int facet : contacts_.facet)
    if (facet < 0 || static_cast<std::size_t>(facet) >= carrier_->wall().facets.size()) refuse();
  if (builds_ != 0 && !changesNodes_ && nodesAtBuild_.size() != surfaceNodes_.size()) refuse();
  if (changesNodes_) uBefore_.clear();
  if (!uBefore_.empty() && uBefore_.size() != static_cast<std::size_t>(nodeCount())) refuse();
  transfer();
}

}  // namespace dovetail::surface
