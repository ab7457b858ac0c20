// What is refused before a run; places of files: see the cantilever, whose code they share.
#include <map>

#include "../cantilever/refusals.hpp"

namespace dovetail::wave {
namespace {

using cantilever::test::expectChoice;
using cantilever::test::expectRefused;
using cantilever::test::Words;
using io::test::ScratchFolder;

TEST(BadInput, NumbersOutsideTheirRange) {
  const std::map<std::string, Words> values{{"--particles-per-edge", {"0", "9", "-1"}},
                                            {"--dem-length", {"0", "-1", "12.1", "nan", "inf", "5000"}},
                                            {"--fem-length", {"0", "-1", "12.1", "nan", "inf", "5000"}},
                                            {"--overlap", {"0", "-1", "0.4", "1.1", "nan", "inf", "12"}},
                                            {"--stiffness-ratio", {"0", "-1", "nan", "inf"}},
                                            {"--density-ratio", {"0", "-1", "nan", "inf"}},
                                            {"--weight-floor", {"-0.1", "0.5", "nan"}},
                                            {"--cg-width", {"-1", "nan", "inf", "101"}},
                                            {"--penalty", {"-1", "nan", "inf"}},
                                            {"--absorber", {"-1", "nan", "inf"}},
                                            {"--pulse-elements", {"0", "-1", "nan", "inf"}},
                                            {"--omega", {"0", "-1", "nan", "inf"}},
                                            {"--cycles", {"0", "101"}},
                                            {"--amplitude", {"0", "-1", "nan", "101"}},
                                            {"--dt-factor", {"0", "-1", "nan", "5"}},
                                            {"--fem-every", {"0", "1001"}},
                                            {"--until", {"0", "-1", "nan", "inf"}},
                                            {"--threads", {"0", "1025"}},
                                            {"--output-interval", {"0", "-1", "nan"}}};
  for (const auto& [option, bad] : values)
    for (const std::string& value : bad) expectRefused({option, value}, {option});
}

TEST(BadInput, TimeSteps) {
  expectRefused({"--dt-factor", "0.1"}, {"above the critical one", "solid", "give at most", "--dt auto"});
  expectRefused({"--dt-factor", "0.05", "--dt", "auto"}, {"--dt-factor", "--dt"});
  expectRefused({"--dt", "0.001"}, {"--dt", "auto"});
  expectRefused({"--penalty", "1e13"}, {"above the critical one", "--dt auto"});
  expectRefused({"--until", "0.1", "--dt-factor", "1e-9"}, {"--until", "steps"});
}

TEST(BadInput, BarsTooLarge) {
  expectRefused({"--until", "100", "--particles-per-edge", "8"}, {"are too many", "--until", "at most"});
  expectRefused({"--dem-length", "4000", "--particles-per-edge", "8"}, {"are too many", "the lengths"});
}

TEST(BadInput, WordsThatAreNoChoice) {
  const std::map<std::string, Words> choices{{"--scheme", {"conservative", "paper"}},
                                             {"--constraint", {"penalty", "multiplier", "dashpot"}},
                                             {"--gap", {"at-grains", "nodal"}},
                                             {"--weight-profile", {"half-cosine", "linear", "smooth"}},
                                             {"--tension", {"on", "off"}},
                                             {"--material", {"springs", "kirchhoff"}},
                                             {"--mass", {"lumped", "consistent", "matched"}},
                                             {"--fem", {"explicit", "newmark"}},
                                             {"--dashpot-matrix", {"lumped", "consistent"}},
                                             {"--rows", {"per-node", "per-element"}},
                                             {"--kernel-normalisation", {"on", "off"}},
                                             {"--kernel-reach", {"overlap", "outside"}},
                                             {"--order", {"symmetric", "staggered"}},
                                             {"--kernel", {"lucy", "gauss"}},
                                             {"--signal", {"impulse", "cosine"}},
                                             {"--study", {"widths", "pareto", "stability", "constraints"}}};
  for (const auto& [option, names] : choices) expectChoice(option, names);
}

TEST(BadInput, WordsThatAreNoOptionAndEmptyValues) {
  expectRefused({"--cgwidth", "2"}, {"--cgwidth", "--help"});
  expectRefused({"leftover"}, {"leftover", "wave_propagation --help"});
  expectRefused({"--cg-width"}, {"--cg-width", "--help"});
  expectRefused({"--cg-width", "two"}, {"--cg-width", "two"});
  expectRefused({"--cycles", "1.5"}, {"--cycles", "1.5"});
  expectRefused({"--threads", "99999999999"}, {"--threads", "99999999999"});
  expectRefused({"--cg-width", "2", "--cg-width", "3"}, {"--cg-width"});
  for (const char* option : {"--cg-width", "--constraint", "--weight-floor", "--until", "--omega", "--out", "--summary",
                             "--reference", "--dt-factor", "--study"})
    expectRefused({option, "", "--quiet"}, {option});
}

TEST(BadInput, ThingsThatDoNotGoTogether) {
  expectRefused({"--order", "staggered"}, {"--order staggered", "--constraint dashpot --fem newmark"});
  expectRefused({"--scheme", "paper", "--fem", "explicit"}, {"--order staggered", "--order symmetric"});
  expectRefused({"--scheme", "paper", "--gap", "at-grains"}, {"--kernel-reach outside", "--gap nodal"});
  expectRefused({"--scheme", "paper", "--fem-every", "2"}, {"--fem-every", "take 1"});
  expectRefused({"--absorber", "1", "--fem", "newmark"}, {"--absorber", "--fem explicit"});
  expectRefused({"--omega", "0.5", "--pulse-elements", "8"}, {"--omega", "--pulse-elements"});
  expectRefused({"--dem-length", "4", "--overlap", "4"}, {"--overlap", "--dem-length"});
  expectRefused({"--study", "widths", "--summary", "x.json"}, {"--summary", "--out DIR"});
  expectRefused({"--study", "widths", "--reference", "x"}, {"--reference", "leave out"});
}

TEST(BadInput, OptionsThatWouldDoNothing) {
  expectRefused({"--constraint", "multiplier", "--penalty", "1e10"}, {"--penalty", "--constraint multiplier"});
  expectRefused({"--dashpot-matrix", "consistent"}, {"--dashpot-matrix", "--constraint dashpot"});
  expectRefused({"--kernel", "gauss"}, {"--kernel", "--cg-width"});
  expectRefused({"--signal", "impulse", "--cycles", "2"}, {"--cycles", "--signal cosine"});
  expectRefused({"--scheme", "paper", "--omega", "0.5"}, {"--omega", "impulse"});
  expectRefused({"--full-dem", "--gap", "nodal"}, {"--gap", "--full-dem"});
  expectRefused({"--full-dem", "--absorber", "1"}, {"--absorber", "--full-dem"});
  expectRefused({"--output-interval", "0.01"}, {"--output-interval", "--out DIR"});
  expectRefused({"--study", "widths", "--profile"}, {"--profile", "--study"});
  expectRefused({"--quiet", "--profile"}, {"--profile", "--summary FILE"});
}

TEST(BadInput, ReferencesThatAreNotThere) {
  const ScratchFolder folder;
  expectRefused({"--reference", folder.path().string()}, {"--reference", "wave_*P_c*dX.csv", "name the folder"});
}

}  // namespace
}  // namespace dovetail::wave
