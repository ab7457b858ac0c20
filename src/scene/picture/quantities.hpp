// Fields of frames as colours.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dovetail/io_vtk/frame_reader.hpp"
#include "dovetail/picture/colours.hpp"
#include "dovetail/scene/picture.hpp"

namespace dovetail::scene {

/// How a field is told and coloured.
struct Hue {
  std::string name;    ///< of the array in frames, "speed" for the magnitude of "velocity"
  std::string title;   ///< of its bar, without unit
  std::string unit;    ///< SI
  bool signs = false;  ///< both signs mean something
};

/// A number with the prefix of its unit that leaves few digits: factor and unit, (1e-3, "kPa") for about 5e4 Pa.
std::pair<double, std::string> prefixed(double size, const std::string& unit);

/// Fields by which points and cells of a frame can be coloured.
std::vector<std::string> fieldsOf(const io::FrameContent& frame);

Hue quantityNamed(const std::string& name);

/// Values of the field at the points, or of cells; magnitudes of vectors. Empty if the frame has no such field.
std::vector<double> valuesAt(const io::FrameContent& frame, const std::string& name, bool perCell);

/// Ends of colours over several frames.
class Spread {
public:
  void add(std::vector<double> values);
  bool isEmpty() const { return !(least_ <= most_); }
  /// Round ends that enclose all but one in a thousand values; 0 is one of them where it is near.
  ColourRange range(bool signs) const;
  bool goesBeyond(const ColourRange& range) const { return most_ > range.high || least_ < range.low; }

private:
  double least_ = 1e300, most_ = -1e300, low_ = 1e300, high_ = -1e300;
};

}  // namespace dovetail::scene
