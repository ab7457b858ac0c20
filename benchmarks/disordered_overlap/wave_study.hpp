// Pulses through an ensemble of packings.
#pragma once

#include <filesystem>
#include <string>

#include "wave.hpp"

namespace dovetail::disordered_overlap {

struct WaveStudy {
  int packings = 10;
  int workers = 1;
  bool friction = false;                 ///< packings are pressed with it: columnPressedWithFriction
  double width = 4.0 * grain::diameter;  ///< m
  double strain = 2e-5, weight = 0.3;    ///< as in WaveOptions
  std::filesystem::path folder = ".";
};

/// Runs P and S pulses through every packing, with tables of each in the folder, and prints what the ensemble says.
/// @return whether all packings were run
bool runWaveStudy(const WaveStudy& study);

}  // namespace dovetail::disordered_overlap
