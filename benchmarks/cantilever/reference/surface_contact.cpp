#include "reference/surface_contact.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::cantilever {

using Eigen::Vector2d;
using Eigen::VectorXd;

BeamSurfaceContact::BeamSurfaceContact(const ModeTable& table, TopSurface surface, double stiffness, double radius)
    : table_(table), surface_(surface), stiffness_(stiffness), radius_(radius) {}

BeamSurfaceContact::Point BeamSurfaceContact::surfacePoint(double s) const {
  const BeamFields f = table_.fields(cell_, s);
  const auto& [w, w1, w2] = f.vertical;
  const auto& [angle, angle1, angle2] = f.rotation;
  const auto& [u, u1, u2] = f.axial;
  const double lever = surface_.lever, sine = std::sin(angle), cosine = std::cos(angle);
  return {.position = {s + u - lever * sine, surface_.height + w + lever * (cosine - 1.0)},
          .first = {1.0 + u1 - lever * cosine * angle1, w1 - lever * sine * angle1},
          .second = {u2 - lever * (cosine * angle2 - sine * angle1 * angle1),
                     w2 - lever * (sine * angle2 + cosine * angle1 * angle1)},
          .sine = sine,
          .cosine = cosine};
}

// Newton on (centre − P) · P' = 0, held inside the beam: beyond the free end the closest point is the end itself.
BeamSurfaceContact::Point BeamSurfaceContact::closestPoint(const Vector2d& centre, const VectorXd& q, double& s) {
  const double tolerance = 1e-14 * table_.length();
  table_.loadCell(s, q, cell_);
  Point point = surfacePoint(s);
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Vector2d gap = centre - point.position;
    const double slope = gap.dot(point.second) - point.first.squaredNorm();
    if (!(slope < 0.0)) break;  // no minimum nearby, or NaN
    const double next = std::clamp(s - gap.dot(point.first) / slope, 0.0, table_.length());
    const double change = std::abs(next - s);
    s = next;
    if (table_.cellOf(s) != cell_.index) table_.loadCell(s, q, cell_);
    point = surfacePoint(s);
    if (change <= tolerance) return point;
  }
  throw NumericalError("no closest point of the beam's surface found",
                       "particle at y = " + formatNumber(centre[0]) + " m, z = " + formatNumber(centre[1]) + " m",
                       "reduce the time step");
}

void BeamSurfaceContact::update(const Vector2d& centre, const VectorXd& q, SphereContact& contact) {
  const Point point = closestPoint(centre, q, contact.position);
  const Vector2d gap = centre - point.position;
  const double distance = gap.norm();
  contact.overlap = radius_ - distance;
  if (contact.overlap <= 0.0) {
    contact.energy = 0.0;
    contact.force.setZero();
    contact.modalForce.setZero(q.size());
    return;
  }
  const Vector2d normal = gap / distance;
  contact.energy = 0.5 * stiffness_ * contact.overlap * contact.overlap;
  contact.force = stiffness_ * contact.overlap * normal;
  table_.gradients(cell_, contact.position, gradients_);
  const double perRotation = -surface_.lever * (point.cosine * contact.force[0] + point.sine * contact.force[1]);
  contact.modalForce.noalias() =
      -contact.force[1] * gradients_.vertical - perRotation * gradients_.rotation - contact.force[0] * gradients_.axial;
}

}  // namespace dovetail::cantilever
