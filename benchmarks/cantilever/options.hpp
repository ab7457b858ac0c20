// The command line of the cantilever program.
#pragma once

#include "settings.hpp"

namespace dovetail::cantilever {

/// @throws InputError for unknown options and impossible values; prints the help and returns false for --help.
bool parseOptions(int argc, char** argv, Settings& settings);

}  // namespace dovetail::cantilever
