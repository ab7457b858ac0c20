// What frames hold.
#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include "dovetail/io_vtk/frame_reader.hpp"
#include "inspecting.hpp"

namespace dovetail::scene {

namespace {

void inspectArray(const io::FrameArray& array, std::ostream& out) {
  const auto n = static_cast<std::size_t>(array.components);
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t k = 0; k + n <= array.values.size(); k += n) {
    double value = array.values[k];
    if (n > 1) {
      value = 0.0;
      for (std::size_t c = 0; c < n; ++c) value += array.values[k + c] * array.values[k + c];
      value = std::sqrt(value);
    }
    least = std::min(least, value);
    most = std::max(most, value);
  }
  out << "  " << array.name << (array.perCell ? " per cell" : " per point");
  if (n > 1) out << ", " << n << " components, magnitude";
  if (!array.values.empty()) out << ": " << least << " … " << most;
  out << '\n';
}

}  // namespace

bool inspectFrames(const std::filesystem::path& file, std::ostream& out) {
  const std::string ending = file.extension().string();
  if (ending == ".pvd") {
    const auto frames = io::readPvd(file);
    out << "series of " << frames.size() << " frames";
    if (!frames.empty()) out << ", t = " << frames.front().first << " … " << frames.back().first << " s; the last:\n";
    return frames.empty() || inspectFrames(frames.back().second, out);
  }
  if (ending != ".vtu" && ending != ".vtp" && ending != ".vti") return false;
  const io::FrameContent frame = io::readFrame(file);
  for (const std::string& line : frame.provenance) out << ' ' << line << '\n';
  out << frame.kind << " of " << frame.position.size() << " points and " << frame.cells << " cells";
  if (frame.time) out << " at t = " << *frame.time << " s";
  out << '\n';
  for (const io::FrameArray& array : frame.arrays) inspectArray(array, out);
  return true;
}

}  // namespace dovetail::scene
