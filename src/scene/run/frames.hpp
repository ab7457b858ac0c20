// Frames for ParaView that a run writes while it goes on.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "dovetail/fem/solve/modes.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// @throws InputError for contents that would do nothing, and in builds without VTK
void requireFrames(const Output& output);

/// @throws InputError as requireFrames
class Frames {
public:
  /// @param times  of the frames that an earlier run has written and this one goes on with, s
  Frames(const Built& built, const Scene& scene, const std::filesystem::path& folder, const io::KeyValues& provenance,
         const std::vector<double>& times);
  ~Frames();
  /// What becomes of the frame before if no time has passed since: files of frames have a time each, and what is kept
  /// is followed by one 1e-12 s later.
  enum class SameInstant { replaced, kept };
  void add(const Built& built, SameInstant before = SameInstant::replaced);
  std::vector<double> times() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The modes of a solid as frames of modes_<name>.pvd, with the numbers of the modes, from 1, in the place of times:
/// `shape` (the largest displacement is 1), and `displacement`, the present one with a tenth of the mesh's extent of
/// it.
void writeModes(const std::filesystem::path& folder, const Built& built, std::size_t solid, const fem::Modes& modes,
                const io::KeyValues& provenance);

}  // namespace dovetail::scene
