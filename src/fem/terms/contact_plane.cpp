#include "dovetail/fem/terms/contact_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact_point.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "mesh/faces.hpp"

namespace dovetail::fem {

namespace {

void validate(const ContactOptions& options) {
  if (options.penalty == 0.0)
    throw InputError("there is no penalty", "ContactOptions",
                     "give one in Pa/m, for instance that of contactPenalty()");
  requirePositive(options.penalty, "penalty");
  requireNonNegative(options.friction, "friction");
  requireNonNegative(options.tangentialPenalty, "tangentialPenalty");
  if (options.augmented) requirePositive(options.gapTolerance, "gapTolerance");
  if (options.maxAugmentations < 1)
    throw InputError("no augmentations are allowed", "ContactOptions", "give maxAugmentations of 1 or more");
}

/// A quadrature point of a face.
struct Spot {
  std::array<int, 9> node;
  std::array<double, 9> N;
  std::size_t nodes;
  double area;  // m²
};

std::vector<Spot> makeSpots(const SolidMesh& mesh, std::span<const Face> faces) {
  std::vector<Spot> spots;
  for (const Face& face : faces) {
    const std::span<const int> corners = nodesOf(face);
    visitPoints(face.shape, [&](const FacePoint& point) {
      Spot spot{face.node, {}, corners.size(), 0.0};
      std::copy(point.N.begin(), point.N.end(), spot.N.begin());
      spot.area = point.weight * norm(areaAt(mesh, face, point));
      spots.push_back(spot);
    });
  }
  return spots;
}

class PlaneTerm : public ContactPlane {
public:
  PlaneTerm(const SolidMesh& mesh, std::span<const Face> faces, const Plane& plane, const ContactOptions& options)
      : faces_(faces.begin(), faces.end()),
        spots_(makeSpots(mesh, faces)),
        plane_(plane),
        options_(options),
        law_{normalized(plane.normal), options.penalty,
             options.tangentialPenalty > 0.0 ? options.tangentialPenalty : options.penalty, options.friction},
        lambda_(spots_.size(), 0.0) {}

  std::string name() const override { return options_.name; }
  bool isSymmetric() const override { return options_.friction == 0.0; }
  bool hasEnergy() const override { return true; }

  bool usesVelocity() const override { return false; }
  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override {
    start(nodes.X, nodes.u, now.t);
    visit(nodes, now.t,
          [&](std::size_t q, const Vec3& d) { scatter(q, law_.at(d, past_[q], lambda_[q]).traction, f); });
  }
  double energy(const Nodes& nodes, const Instant& now) override {
    start(nodes.X, nodes.u, now.t);
    double sum = 0.0;
    visit(nodes, now.t, [&](std::size_t q, const Vec3& d) {
      sum += spots_[q].area * law_.energy(law_.at(d, past_[q], lambda_[q]), lambda_[q]);
    });
    return sum;
  }
  void addPattern(linalg::MatrixPattern& pattern) const override {
    for (const Face& face : faces_) pattern.add(nodesOf(face));
  }
  void addTangent(const Nodes& nodes, const Instant& now, linalg::BlockMatrix& K) override {
    start(nodes.X, nodes.u, now.t);
    visit(nodes, now.t, [&](std::size_t q, const Vec3& d) {
      // Just touching, as at the start of most load steps: without it nothing might hold the solid.
      if (lambda_[q] - law_.penalty * dot(law_.normal, d) >= 0.0)
        addBlocks(q, law_.tangent(law_.at(d, past_[q], lambda_[q])), K);
    });
  }

  bool addConservingForces(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                           std::span<Vec3> f) override {
    if (options_.friction > 0.0) return false;
    start(nodes.X, u0, now.t - now.dt);
    visit(nodes, now.t, [&](std::size_t q, const Vec3& d) {
      scatter(q, law_.meanPressure(startOf(q, nodes, u0, now), d, lambda_[q]) * law_.normal, f);
    });
    return true;
  }
  void addConservingTangent(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                            linalg::BlockMatrix& K) override {
    visit(nodes, now.t, [&](std::size_t q, const Vec3& d) {
      const double slope = law_.meanPressureSlope(startOf(q, nodes, u0, now), d, lambda_[q]);
      if (slope != 0.0) addBlocks(q, scaledOuterProduct(slope, law_.normal, law_.normal), K);
    });
  }

  double commit(const Nodes& nodes, const Instant& now) override {
    start(nodes.X, nodes.u, now.t);
    double booked = 0.0;
    Vec3 force;
    visit(nodes, now.t, [&](std::size_t q, const Vec3& d) {
      ContactPast& past = past_[q];
      const ContactAnswer answer = law_.at(d, past, lambda_[q]);
      booked += spots_[q].area * (law_.dissipated(answer, past) + law_.jump(past, lambda_[q]));
      force += spots_[q].area * answer.traction;
      past = {d, answer.spring, lambda_[q]};
    });
    const Vec3 moved = origin(now.t) - pastOrigin_;
    workOfMotion_ = 0.5 * dot(force + pastForce_, moved);
    pastOrigin_ += moved;
    pastForce_ = force;
    augmentations_ = 0;
    return booked;
  }
  double workOfMotion() const override { return workOfMotion_; }
  bool augment(const Nodes& nodes, const Instant& now) override {
    if (!options_.augmented || augmentations_ >= options_.maxAugmentations) return false;
    bool violated = false;
    visit(nodes, now.t, [&](std::size_t q, const Vec3& d) {
      const double gap = dot(law_.normal, d), pressure = std::max(0.0, lambda_[q] - law_.penalty * gap);
      // Where there is a multiplier but no contact any more, the excess is what the multiplier stood for.
      violated = violated || std::abs(pressure - lambda_[q]) > law_.penalty * options_.gapTolerance;
    });
    if (!violated) return false;
    visit(nodes, now.t, [&](std::size_t q, const Vec3& d) {
      lambda_[q] = std::max(0.0, lambda_[q] - law_.penalty * dot(law_.normal, d));
    });
    ++augmentations_;
    return true;
  }
  void revert() override {
    for (std::size_t q = 0; q < lambda_.size(); ++q) lambda_[q] = past_.empty() ? 0.0 : past_[q].lambda;
    augmentations_ = 0;
  }

  void save(ByteWriter& archive) const override { archive(past_, pastOrigin_, pastForce_); }
  void load(ByteReader& archive) override {
    std::vector<ContactPast> past;
    Vec3 origin, force;
    archive(past, origin, force);
    if (!past.empty() && past.size() != spots_.size())
      throw InputError("the state is that of another contact", options_.name, "restart with the same mesh and faces");
    const bool finite = std::ranges::all_of(past, [](const ContactPast& spot) {
      return isFinite(spot.d) && isFinite(spot.spring) && std::isfinite(spot.lambda);
    });
    if (!finite || !isFinite(origin) || !isFinite(force))
      throw InputError("the state is not finite", options_.name, "take an older one");
    past_ = std::move(past);
    pastOrigin_ = origin;
    pastForce_ = force;
    revert();
  }

  Report report(const Nodes& nodes, const Instant& now) const override {
    Report report;
    visit(nodes, now.t, [&](std::size_t q, const Vec3& d) {
      const ContactAnswer answer = law_.at(d, past_.empty() ? ContactPast{d, {}, 0.0} : past_[q], lambda_[q]);
      report.force += spots_[q].area * answer.traction;
      if (!(answer.pressure > 0.0)) return;
      report.area += spots_[q].area;
      report.deepest = std::max(report.deepest, -dot(law_.normal, d));
      report.largestPressure = std::max(report.largestPressure, answer.pressure);
    });
    return report;
  }

  /// As if all faces touched.
  void addStiffness(const Nodes&, const Instant&, std::span<double> k) override {
    const double penalty = law_.friction > 0.0 ? std::max(law_.penalty, law_.tangentialPenalty) : law_.penalty;
    for (const Spot& spot : spots_) {
      double sum = 0.0;
      for (std::size_t b = 0; b < spot.nodes; ++b) sum += std::abs(spot.N[b]);
      for (std::size_t a = 0; a < spot.nodes; ++a)
        k[static_cast<std::size_t>(spot.node[a])] += penalty * spot.area * std::abs(spot.N[a]) * sum;
    }
  }

private:
  Vec3 origin(double t) const { return plane_.motion ? plane_.point + plane_.motion(t) : plane_.point; }
  std::span<const int> corners(std::size_t q) const { return {spots_[q].node.data(), spots_[q].nodes}; }
  std::span<const double> shapes(std::size_t q) const { return {spots_[q].N.data(), spots_[q].nodes}; }
  /// Place relative to a plane through `from`.
  Vec3 placeOf(std::size_t q, std::span<const Vec3> X, std::span<const Vec3> u, const Vec3& from) const {
    return interpolate(shapes(q), corners(q), X) + interpolate(shapes(q), corners(q), u) - from;
  }
  /// Calls act(q, place relative to the plane).
  template <class Act>
  void visit(const Nodes& nodes, double t, Act&& act) const {
    const Vec3 o = origin(t);
    for (std::size_t q = 0; q < spots_.size(); ++q) act(q, placeOf(q, nodes.X, nodes.u, o));
  }
  Vec3 startOf(std::size_t q, const Nodes& nodes, std::span<const Vec3> u0, const Instant& now) const {
    return placeOf(q, nodes.X, u0, origin(now.t - now.dt));
  }
  /// The state of the first use is the past of the first step.
  void start(std::span<const Vec3> X, std::span<const Vec3> u, double t) {
    if (!past_.empty()) return;
    pastOrigin_ = origin(t);
    for (std::size_t q = 0; q < spots_.size(); ++q) {
      past_.push_back({placeOf(q, X, u, pastOrigin_), {}, 0.0});
      pastForce_ += spots_[q].area * law_.at(past_[q].d, past_[q], lambda_[q]).traction;
    }
  }
  void scatter(std::size_t q, const Vec3& traction, std::span<Vec3> f) const {
    if (traction == Vec3{}) return;
    for (std::size_t a = 0; a < spots_[q].nodes; ++a)
      f[static_cast<std::size_t>(spots_[q].node[a])] += spots_[q].N[a] * spots_[q].area * traction;
  }
  void addBlocks(std::size_t q, const std::array<double, 9>& block, linalg::BlockMatrix& K) const {
    const Spot& spot = spots_[q];
    for (std::size_t a = 0; a < spot.nodes; ++a)
      for (std::size_t b = 0; b < spot.nodes; ++b) {
        std::array<double, 9> scaled = block;
        for (double& value : scaled) value *= spot.area * spot.N[a] * spot.N[b];
        K.addBlock(spot.node[a], spot.node[b], scaled);
      }
  }

  std::vector<Face> faces_;
  std::vector<Spot> spots_;
  Plane plane_;
  ContactOptions options_;
  ContactPointLaw law_;
  std::vector<ContactPast> past_;  // empty until the first use
  std::vector<double> lambda_;
  Vec3 pastOrigin_, pastForce_;
  double workOfMotion_ = 0.0;
  int augmentations_ = 0;
};

}  // namespace

double contactPenalty(const SolidMesh& mesh, std::span<const Face> faces, double confinedModulus) {
  requireFaces(faces, mesh, "contactPenalty");
  double area = 0.0;
  for (const Spot& spot : makeSpots(mesh, faces)) area += spot.area;
  const double mean = area / static_cast<double>(faces.size());
  const double size = dimensionOf(mesh) == 2 ? mean / mesh.thickness : std::sqrt(mean);
  return 10.0 * confinedModulus / size;
}

std::shared_ptr<ContactPlane> makeContactPlane(const SolidMesh& mesh, std::span<const Face> faces, const Plane& plane,
                                               const ContactOptions& options) {
  validate(options);
  requireFaces(faces, mesh, "makeContactPlane");
  if (!(norm(plane.normal) > 0.0) || !isFinite(plane.normal) || !isFinite(plane.point))
    throw InputError("the plane is not defined", "makeContactPlane", "give a finite point and a normal with length");
  return std::make_shared<PlaneTerm>(mesh, faces, plane, options);
}

}  // namespace dovetail::fem
