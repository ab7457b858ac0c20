// Frames for ParaView that a run writes while it goes on.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

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
  void add(const Built& built);
  std::vector<double> times() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::scene
