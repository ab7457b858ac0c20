// The command line of the wave_propagation program.
#pragma once

#include "settings.hpp"

namespace dovetail::wave {

/// @throws InputError for unknown options and impossible values; prints the help and returns false for --help.
bool parseOptions(int argc, char** argv, Settings& settings);

}  // namespace dovetail::wave
