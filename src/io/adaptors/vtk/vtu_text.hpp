// A frame as the text of a VTU file; the only part that knows VTK.
#pragma once

#include <string>

#include "dovetail/io_vtk/vtu_series.hpp"

namespace dovetail::io {

/// The frames must be checked: sizes of fields and indices of cells are taken as they are.
/// @throws Error if VTK fails
std::string vtuText(double time, const HexFrame& frame, const KeyValues& provenance);
std::string vtuText(double time, const ParticleFrame& frame, const KeyValues& provenance);
std::string vtuText(double time, const PointFrame& frame, const KeyValues& provenance);
std::string vtpText(double time, const PolyFrame& frame, const KeyValues& provenance);

}  // namespace dovetail::io
