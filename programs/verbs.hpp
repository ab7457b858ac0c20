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
/// calibrate FILE; refused where the build has no Ceres.
Verb addCalibrate(CLI::App& app);

/// Lets scenes fill surfaces with tetrahedra, where the program is built for it (DOVETAIL_PROGRAM_CGAL).
void offerTetrahedra();

/// A verb that reads its own command line.
struct OwnVerb {
  const char *name, *help;
  /// @param argv  the verb, then its arguments @return whether all was done. @throws InputError
  bool (*act)(int argc, char** argv);
};

bool studyScene(int argc, char** argv);
bool reportRun(int argc, char** argv);

inline constexpr OwnVerb ownVerbs[] = {
    {"study", "runs a scene over lists of parameters, in several processes", studyScene},
    {"report", "writes a page (HTML, Markdown) on a run", reportRun},
};

}  // namespace dovetail::program
