// What conditions on the sides leave of the fluctuations of a frame.
#pragma once

#include "border.hpp"

namespace dovetail::rve {

/// @param frame  whose grains and copies are known, in the order of the border
void setFreedom(Frame& frame, const Border& border, const Conditions& conditions);

}  // namespace dovetail::rve
