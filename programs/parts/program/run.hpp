// How a benchmark program ends.
#pragma once

#include <functional>
#include <string>

#include "program/options.hpp"

namespace dovetail::program {

/// What signals that ask to end do: end the program, or are noted for a body that asks for them
/// (dovetail/io/interruption.hpp).
enum class Signals { end, noted };

/// Calls the body and returns the exit code: 0 if it has done what it was asked for; 2 if it throws an InputError;
/// 128 + number if it stopped for a signal (130 for SIGINT, 143 for SIGTERM); 1 if it stopped or threw for another
/// reason, want of memory too. Errors go to standard error behind the program's name.
/// @param body returns whether all was done; if not, it has said why
int runProgram(const std::string& name, const std::function<bool()>& body, Signals signals = Signals::end);
/// The same of a program that has options, once they are read; --help is all that is asked for where it is written.
int runProgram(Options& options, int argc, char** argv, const std::function<bool()>& body);

}  // namespace dovetail::program
