#include "dovetail/mpm/point_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/impact.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/fem/laws/tensor.hpp"

namespace dovetail::mpm {

namespace {

constexpr std::size_t pointChunk = 512;
std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// ∂w/∂x of the nodes that a point reaches, at their present places: the cofactor of 1 + ∂u/∂X over its determinant.
std::vector<Vec3> presentSlopes(const GridRows& rows, std::size_t p, std::span<const Vec3> u) {
  fem::Tensor<double> G{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  const Vec3* const slope = &rows.slope[rows.perPoint * p];
  eachReached(rows, p, u, [&](std::size_t a, const Vec3& own) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) G[at(3 * i + j)] += own[i] * slope[a][j];
  });
  const fem::Tensor<double> C = fem::cofactor(G);
  const double perVolume = 1.0 / fem::determinant(G);
  std::vector<Vec3> slopes(rows.perPoint);
  for (std::size_t a = 0; a < slopes.size(); ++a)
    for (int i = 0; i < 3; ++i)
      slopes[a][i] =
          perVolume * (C[at(3 * i)] * slope[a].x + C[at(3 * i + 1)] * slope[a].y + C[at(3 * i + 2)] * slope[a].z);
  return slopes;
}

/// Whether nodes beyond a border count for it, of which mirrored ones stand in.
bool reachesBeyond(const GridRows& rows, std::size_t p) {
  const std::size_t first = rows.perPoint * at(rows.cell[p]);
  return std::any_of(&rows.flip[first], &rows.flip[first] + rows.perPoint, [](auto flip) { return flip != 0; });
}

Vec3 halfCurlAt(const GridRows& rows, std::size_t p, std::span<const Vec3> u, std::span<const Vec3> v) {
  const std::vector<Vec3> slopes = presentSlopes(rows, p, u);
  Vec3 sum;
  eachReached(rows, p, v, [&](std::size_t a, const Vec3& own) { sum += 0.5 * cross(slopes[a], own); });
  return sum;
}

}  // namespace

const std::vector<int>& PointContact::numbers(const dem::Particles& particles) const {
  if (located_ == particles.revision) return number_;
  number_.clear();
  for (const std::int64_t id : ids_) number_.push_back(dem::find(particles, id));
  located_ = particles.revision;
  return number_;
}

void PointContact::check(const dem::Model& m) const {
  for (const int i : numbers(m.particles)) {
    if (i < 0)
      throw InputError("some of its particles are gone", name(), "keep the particles that addSpheres has added");
    if (const double weight = m.particles.weightOf(at(i)); weight != 1.0)
      throw InputError("particle " + std::to_string(m.particles.id[at(i)]) + " has the weight " + formatNumber(weight),
                       name(), "keep material points out of overlap volumes");
  }
}

void PointContact::own(dem::Particles& particles) const {
  for (const int i : numbers(particles)) dem::setOwner(particles, i, dem::Owner::solid);
}

double PointContact::placeParticles(dem::Model& m, std::span<const Vec3> v) {
  dem::Particles& particles = m.particles;
  const geometry::Periodicity& space = m.pairs.periodicity();
  const std::vector<int>& number = numbers(particles);
  const GridRows& rows = points_->rows();
  const std::span<const Vec3> u = side().nodes().u;
  const std::vector<Vec3> places = points_->places(side().nodes());
  std::vector<double> squared((number.size() + pointChunk - 1) / pointChunk, 0.0);
  parallelFor(number.size(), pointChunk, [&](std::size_t begin, std::size_t end) {
    double& largest = squared[begin / pointChunk];
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t i = at(number[p]);
      const Vec3 before = particles.x[i];
      const Vec3 x = space.any() ? before + space.minimumImage(places[p] - before) : places[p];
      const double moved = squaredNorm(x - before);
      if (!(moved <= largest)) largest = std::isfinite(moved) ? moved : std::numeric_limits<double>::infinity();
      particles.x[i] = x;
      particles.v[i] = valueAt(rows, p, v);
      if (particles.rotates()) particles.omega[i] = halfCurlAt(rows, p, u, v);
    }
  });
  return std::sqrt(*std::ranges::max_element(squared));
}

void PointContact::close(dem::Model& m, double) { placeParticles(m, side().nodes().v); }

/// Also of points that a fold of the body brings together: they push each other through the grid.
void PointContact::neighbourListUpdated(dem::Model& m) {
  std::vector<char> own(m.particles.size(), 0);
  for (const int i : numbers(m.particles)) own[at(i)] = 1;
  const std::span<double> factors = m.pairs.writeFactors();
  for (std::size_t k = 0; k < m.pairs.size(); ++k)
    if (const auto& [i, j] = m.pairs.pairs()[k]; own[at(i)] != 0 && own[at(j)] != 0) factors[k] = 0.0;
}

void PointContact::leaving(dem::Model& m, std::vector<char>& leaves) {
  const std::vector<int>& number = numbers(m.particles);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (leaves[at(number[p])] != 0)
      throw NumericalError("it has left the domain of the particles",
                           "point " + std::to_string(p) + " of \"" + side().name + "\"",
                           "widen the domain, or put a wall or a border of the grid in its way");
}

void PointContact::addForces(dem::Model& m, const dem::Step&) {
  dem::Particles& particles = m.particles;
  const std::vector<int>& number = numbers(particles);
  const GridRows& rows = points_->rows();
  const std::span<const Vec3> u = side().nodes().u;
  ofBorders_ = {};
  for (std::size_t p = 0; p < number.size(); ++p) {
    const std::size_t i = at(number[p]), first = rows.perPoint * at(rows.cell[p]);
    const Vec3 force = particles.f[i] - particles.mass[i] * m.gravity;
    const Vec3 torque = particles.rotates() ? particles.torque[i] : Vec3{};
    particles.f[i] = {};
    if (particles.rotates()) particles.torque[i] = {};
    if (force == Vec3{} && torque == Vec3{}) continue;
    const std::vector<Vec3> slopes = torque == Vec3{} ? std::vector<Vec3>() : presentSlopes(rows, p, u);
    const bool nearBorder = reachesBeyond(rows, p);
    for (std::size_t a = 0; a < rows.perPoint; ++a) {
      Vec3 share = rows.weight[rows.perPoint * p + a] * force;
      if (!slopes.empty()) share += 0.5 * cross(torque, slopes[a]);
      const int node = rows.node[first + a];
      share = flipped(share, rows.flip[first + a]);
      side().load.add(node, share);
      if (nearBorder) ofBorders_.add(rows.X[at(node)] + u[at(node)], share);
    }
    if (nearBorder) {
      ofBorders_.add(particles.x[i], -1.0 * force);
      ofBorders_.angular -= torque;
    }
  }
}

/// Points in contact feel the forces of the solid too. Implicit solids move once a macro step.
void PointContact::addOwnForces(dem::ContactDemand& demand, double rate) const {
  for (std::size_t p = 0; p < number_.size(); ++p)
    dem::addOwnForces(demand, at(number_[p]), points_->masses()[p], rate);
}

void PointContact::addEnergies(const dem::Model& m, dem::Energies& e) const {
  for (const int number : numbers(m.particles)) {  // which the sums over particles hold
    const std::size_t i = at(number);
    e.gravity += m.particles.mass[i] * dot(m.gravity, m.particles.x[i]);
    e.kinetic -= 0.5 * m.particles.mass[i] * squaredNorm(m.particles.v[i]);
    if (m.particles.rotates())
      e.kinetic -= 0.5 * dem::momentOfInertia(m.particles, number) * squaredNorm(m.particles.omega[i]);
  }
}

void PointContact::addMomenta(const dem::Model& m, Momenta& sums) const {
  for (const int number : numbers(m.particles)) {
    const std::size_t i = at(number);
    const Vec3 momentum = m.particles.mass[i] * m.particles.v[i];
    sums.linear -= momentum;
    sums.angular -= cross(m.particles.x[i], momentum);
    if (m.particles.rotates()) sums.angular -= dem::momentOfInertia(m.particles, number) * m.particles.omega[i];
  }
}

void PointContact::addOutside(const dem::Model&, Momenta& force, Momenta&) const { force += ofBorders_; }

PointContact& addSpheres(dem::Model& grains, coupling::SolidSide& side, std::shared_ptr<const PointSolid> points,
                         const SphereOptions& options) {
  if (points == nullptr) throw InputError("there are no points", "mpm::addSpheres", "give those of makePoints");
  const std::string where = "contact of \"" + points->name() + "\"";
  requirePositive(options.radius, "radius of " + where);
  if (options.material < 0 || options.material > std::numeric_limits<std::uint8_t>::max())
    throw InputError("the material is " + std::to_string(options.material), where, "give a row of the contact laws");
  dem::Particles& particles = grains.particles;
  const std::vector<Vec3> places = points->places(side.nodes());
  std::vector<std::int64_t> ids;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const auto i = at(dem::addParticle(particles, places[p], {}, options.radius, dem::Mass{points->masses()[p]}));
    if (options.material != 0 && particles.material.empty()) particles.material.resize(particles.size(), 0);
    if (!particles.material.empty()) particles.material[i] = static_cast<std::uint8_t>(options.material);
    ids.push_back(particles.id[i]);
  }
  return grains.terms.add(PointContact(side, std::move(points), std::move(ids)));
}

}  // namespace dovetail::mpm
