// Contact of a sphere with the top surface of the deformed beam.
#pragma once

#include <Eigen/Core>

#include "reference/mode_table.hpp"

namespace dovetail::cantilever {

/// Material point s of the top surface is at
///   y = s + u(s) − lever sin θ(s),   z = height + w(s) + lever (cos θ(s) − 1)
/// with u, w the displacements of the axis along y and z,
/// lever = height for sections that turn rigidly, lever = 0 for a surface that only follows the axis.
struct TopSurface {
  double height = 0.0, lever = 0.0;  ///< m
};

struct SphereContact {
  double position = 0.0;            ///< s of the closest point, m; the start of the next search
  double overlap = 0.0;             ///< > 0 when touching, m
  double energy = 0.0;              ///< ½ k ⟨overlap⟩², J
  Eigen::Vector2d force{0.0, 0.0};  ///< on the sphere, along y and z, N
  Eigen::VectorXd modalForce;       ///< on each mode, −∂energy/∂q_j
};

/// All forces are minus the gradient of energy(centre, q) = ½ k ⟨R − d⟩², with d the distance from the sphere's centre
/// to the surface. d is stationary (or at an end of the beam) in s, so ∂d/∂q_j = −n · ∂P/∂q_j at fixed s.
class BeamSurfaceContact {
public:
  BeamSurfaceContact(const ModeTable& table, TopSurface surface, double stiffness, double radius);

  /// Updates `contact` for a sphere centred at (y, z) and amplitudes q. The closest point is searched from
  /// contact.position.
  /// @throws NumericalError if the search does not converge
  void update(const Eigen::Vector2d& centre, const Eigen::VectorXd& q, SphereContact& contact);

private:
  struct Point {
    Eigen::Vector2d position, first, second;  // with derivatives by s
    double sine, cosine;                      // of θ
  };
  Point surfacePoint(double s) const;
  Point closestPoint(const Eigen::Vector2d& centre, const Eigen::VectorXd& q, double& s);

  const ModeTable& table_;
  TopSurface surface_;
  double stiffness_, radius_;
  BeamCell cell_;
  BeamGradients gradients_;
};

}  // namespace dovetail::cantilever
