// The verbs of the command line.
#pragma once

namespace dovetail::program {

/// A verb reads its own command line.
struct Verb {
  const char *name, *help;
  /// @param argv  the verb, then its arguments
  /// @return whether all was done: runProgram makes the exit code of it. @throws InputError
  bool (*act)(int argc, char** argv);
};

bool runScene(int argc, char** argv);
bool checkScene(int argc, char** argv);
bool resumeRun(int argc, char** argv);
bool inspectFile(int argc, char** argv);
bool upgradeScene(int argc, char** argv);
bool writeSchema(int argc, char** argv);
bool compareRuns(int argc, char** argv);  ///< false if the two differ by more than the tolerance
bool writeFields(int argc, char** argv);
bool calibrate(int argc, char** argv);    ///< refused where the build has no Ceres
bool testCellsOf(int argc, char** argv);  ///< false if a cell breaks down in a test
bool studyScene(int argc, char** argv);
bool drawRun(int argc, char** argv);
bool reportRun(int argc, char** argv);
bool convertFile(int argc, char** argv);
bool writeStarter(int argc, char** argv);

inline constexpr Verb verbs[] = {
    {"run", "runs a scene", runScene},
    {"check", "builds a scene, and prints sizes, critical steps, memory and run time", checkScene},
    {"resume", "continues a run from its last checkpoint", resumeRun},
    {"info", "prints what a file or folder contains", inspectFile},
    {"upgrade", "updates renamed keys and words of a scene file", upgradeScene},
    {"schema", "prints the JSON Schema of scenes, or a reference of their keys", writeSchema},
    {"compare", "compares two runs, or two series, frames or states; exit code 1 if they differ", compareRuns},
    {"fields", "density, velocity, stress … of a run's last checkpoint on a grid, as a VTI file", writeFields},
    {"calibrate", "continuum of a packing, grain parameters from measurements, or the best widths and lengths",
     calibrate},
    {"cell", "makes cells of grains and tests them: moduli, strength, curves", testCellsOf},
    {"study", "runs a scene over lists of parameters, in several processes", studyScene},
    {"picture", "draws a frame of a run, or all of them as a film", drawRun},
    {"report", "writes a page (HTML, Markdown) on a run", reportRun},
    {"convert", "grains and meshes from files of other codes, and into them", convertFile},
    {"new", "prints a commented starter scene, or writes it", writeStarter},
};

/// Lets scenes fill surfaces with tetrahedra, where the program is built for it (DOVETAIL_PROGRAM_CGAL).
void offerTetrahedra();

}  // namespace dovetail::program
