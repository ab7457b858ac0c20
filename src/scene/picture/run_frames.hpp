// Frames of a run, read one instant at a time.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/io_vtk/frame_reader.hpp"
#include "dovetail/scene/scene.hpp"

namespace dovetail::scene {

/// What frames hold at one time, by the name of their series: "grains", "contacts", "bonds", "solid_<name>",
/// "wall_<k>".
struct Instant {
  double time = 0.0;  ///< s
  std::map<std::string, io::FrameContent> parts;

  const io::FrameContent* find(const std::string& name) const;
};

class RunFrames {
public:
  /// @param modes  of those of the solids, named as these  @param cell  if not empty: its grains and contacts alone
  /// @throws InputError if there is no frame
  RunFrames(const std::filesystem::path& folder, const Scene& scene, bool modes, const std::string& cell);
  std::size_t count() const { return times_.size(); }
  /// The number of a frame that is counted from the end if negative. @throws InputError if there is none
  std::size_t numberOf(int frame) const;
  Instant read(std::size_t frame) const;
  bool has(const std::string& series) const { return files_.contains(series); }

private:
  std::vector<double> times_;
  std::map<std::string, std::map<double, std::filesystem::path>> files_;
};

}  // namespace dovetail::scene
