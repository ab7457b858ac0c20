// The verbs of the command line that have files of their own.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace dovetail::program {

struct Verb {
  CLI::App* app;
  std::function<int()> act;  ///< returns the exit code
};

/// compare A B: exit code 1 if the two differ by more than the tolerance.
Verb addCompare(CLI::App& app);
/// fields RUN: coarse-grained fields of its last checkpoint.
Verb addFields(CLI::App& app);

}  // namespace dovetail::program
