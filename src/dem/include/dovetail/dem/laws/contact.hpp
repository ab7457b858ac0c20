// Input and results of the parts of a contact law.
#pragma once

#include "dovetail/core/vec3.hpp"
#include "dovetail/dem/laws/contact_work.hpp"

namespace dovetail::dem {

/// What a contact remembers of how its two bodies moved in the last step. Dashpots see velocities of the instant of the
/// force, v₊ + ½(v₊ − v₋), as the loop over contacts knows those of the half steps before it, v₊ and v₋.
enum class Recall { nothing, approach, motion };

/// What the numbers mean that a contact with a wall remembers.
struct WallMemoryKind {
  unsigned springs = 0;  ///< ContactLaw::memoryKind
  int velocities = 0;    ///< how many follow behind the springs
  friend bool operator==(const WallMemoryKind&, const WallMemoryKind&) = default;
};

/// Two bodies in contact: particle and partner (a particle, or a wall that counts as infinitely heavy and flat).
/// Velocities are those of this instant, where the law's dashpots say so (PreparedParts::recall), else those of the
/// half step before.
struct Contact {
  double overlap = 0.0;             ///< δ, m; > 0 while they touch
  double overlapBefore = 0.0;       ///< δ one step ago, m; < 0 if they were apart
  double separating = 0.0;          ///< n·velocity, m/s; > 0 while the overlap closes
  double separated = 0.0;           ///< n·displacement in this step, while they touched, m
  double engagement = 1.0;          ///< factor on all dashpots: what counts of the step of the first touch, and of the
                                    ///< last one if the normal part may pull; 1 in all others
  double engagementUntilEnd = 1.0;  ///< the same for forces that begin and end at once (ContactLaw::jumps), in both
  double effectiveMass = 0.0;       ///< m₁m₂/(m₁ + m₂), kg; only where a part has `needsMass`
  double rootMass = 0.0;            ///< its square root, kg^½
  double inverseMass = 0.0;         ///< 1/effectiveMass, 1/kg; 0 where no dashpot asks for it
  double effectiveRadius = 0.0;     ///< R₁R₂/(R₁ + R₂), m; only where a part has `needsRadius`
  Vec3 normal;                      ///< unit, from the partner to the particle
  Vec3 slip;                        ///< tangential velocity of the particle relative to the partner at the contact, m/s
  Vec3 spin;                        ///< angular velocity of the particle minus the partner's, rad/s
  Vec3 slipped;                     ///< tangential displacement in this step, while they touched, m
  Vec3 turned;                      ///< relative rotation in this step, while they touched, rad
  double dt = 0.0;                  ///< step over which memories advance, s
  double inverseDt = 0.0;           ///< 1/dt, 1/s
};

struct NormalResponse {
  double force = 0.0;         ///< N along the normal on the particle; > 0 pushes apart
  double stiffness = 0.0;     ///< N/m, slope of the elastic force, > 0; other parts scale with it
  double firstMean = 1.0;     ///< its mean since first touch over that now, in the step of the first touch
  double damping = 0.0;       ///< N s/m, of the dashpot; other parts scale with it
  double energy = 0.0;        ///< J, recoverable
  double dashpotPower = 0.0;  ///< W, now
  double plasticPower = 0.0;  ///< W, average of this step
};

struct AdhesionResponse {
  double force = 0.0;   ///< N along the normal on the particle; < 0 pulls together
  double energy = 0.0;  ///< J; < 0
};

struct TangentialResponse {
  Vec3 force;                 ///< N on the particle
  double energy = 0.0;        ///< J stored
  double slipPower = 0.0;     ///< W lost to sliding, average of this step
  double dashpotPower = 0.0;  ///< W, now
};

struct RollingResponse {
  Vec3 couple;                ///< N m on the particle, the opposite on the partner
  double energy = 0.0;        ///< J stored
  double slipPower = 0.0;     ///< W lost to sliding, average of this step
  double dashpotPower = 0.0;  ///< W, now
};

/// Turns a stored tangential vector with the pair since the last step: into the present contact plane, and about the
/// normal by the mean spin of both. Its length stays (to the fourth power of the angle of one step).
/// @param twist mean spin of both about the normal times the step, rad
[[gnu::always_inline]] inline Vec3 carried(Vec3 remembered, const Vec3& normal, double twist) {
  const double before = squaredNorm(remembered);
  remembered += twist * cross(normal, remembered);
  remembered -= dot(remembered, normal) * normal;
  const double ratio = squaredNorm(remembered) / (before > 0.0 ? before : 1.0);
  return (1.5 - 0.5 * ratio) * remembered;  // 1/√ratio for a ratio near 1, and bounded for any
}

/// Present stiffness and damping of a part of a law, which limit the time step (see contact_step.hpp).
struct Slope {
  double stiffness = 0.0;  ///< N/m (rolling: N m/rad), of the spring
  double damping = 0.0;    ///< N s/m (rolling: N m s/rad), of the dashpot
};
struct ContactSlopes {
  Slope normal, tangential, rolling;
};

/// Result of the whole law.
struct ContactResponse {
  Vec3 force;   ///< N on the particle
  Vec3 couple;  ///< N m on the particle beyond arm × force
  ContactWork work;
};

}  // namespace dovetail::dem
