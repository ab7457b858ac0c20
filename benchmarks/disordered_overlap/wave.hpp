// A pulse that runs down a column under pressure, all in grains or with a solid below.
#pragma once

#include <string>
#include <vector>

#include "moduli.hpp"

namespace dovetail::disordered_overlap {

/// Lengths in elements; an element is `element` high.
struct WaveOptions {
  bool shear = false;
  double speed = 0.0;                       ///< near that of the wave: the pulse lasts pulse × element / speed, m/s
  double pressure = 1e4;                    ///< Pa
  double element = 3.75 * grain::diameter;  ///< m
  int grains = 9, overlap = 4, solid = 10;  ///< alone, shared, alone
  double pulse = 8.0;
  double strain = 2e-5;  ///< largest of the pulse
  double weight = 0.3;   ///< of the critical step
  double rest = 1e-9;    ///< kinetic over elastic energy, at most, before the pulse
  JoinOptions join{.massFraction = 0.46};
  double shared() const { return grains * element; }             ///< depth below the lid where the solid begins, m
  double alone() const { return (grains + overlap) * element; }  ///< and where grains end
  double depth() const { return (grains + overlap + solid) * element; }
  double duration() const { return pulse * element / speed; }  ///< s
  double end() const {
    return (grains + overlap + pulse + 0.5) * element / speed;
  }  ///< s, the tail has left the overlap
};

/// Means over the section in slabs two diameters thick, from the lid downwards, at equal times.
struct Waveform {
  std::vector<double> depth;                  ///< centres of the slabs, m below the lid
  std::vector<double> mass;                   ///< of the grains in them, kg
  std::vector<double> time;                   ///< s, since the pulse began
  std::vector<std::vector<double>> velocity;  ///< m/s, by time, then slab; NaN within the overlap
};

/// What a pulse did. Energies in J.
struct WaveRun {
  Waveform form;
  double pulse = 0.0;  ///< twice the kinetic energy when the lid has stopped: that of the travelling wave
  double friction = 0.0, overlap = 0.0, residual = 0.0;  ///< booked since the pulse began
  double atRest = 0.0;                                   ///< kinetic energy when it began
  double dt = 0.0, seconds = 0.0;
  std::vector<std::int64_t> id;  ///< of the grains above the overlap, ascending
  std::vector<Vec3> v, omega;    ///< their velocities at the end, m/s, rad/s
  std::vector<double> mass, radius;
};

/// One packing, all in grains and with the solid that matches `moduli`, with the same steps. The packing is as high as
/// the settings ask or higher.
struct WavePair {
  WaveRun full, joined;
  std::size_t particles = 0;
};
WavePair runPair(const dem::Model& packing, const WaveOptions& settings, const Moduli& moduli);

/// Energy of the difference field above the overlap over that of the pulse: twice the kinetic energy of v_joined −
/// v_full, grain by grain, and of the means of slabs.
struct Reflected {
  double byGrain, bySlab;
};
Reflected reflected(const WavePair& pair);

/// ‖a − b‖ over ‖b‖ below a depth, over all times.
double misfit(const Waveform& a, const Waveform& b, double depth);
/// Of waveforms with the same slabs and times.
Waveform mean(const std::vector<const Waveform*>& forms);

}  // namespace dovetail::disordered_overlap
