#include "common/case_program.hpp"
#include "reference_curves.hpp"
#include "texts.hpp"

int main(int argc, char** argv) {
  using namespace dovetail;
  using namespace dovetail::wave;
  const auto filesOf = [](const Settings& settings) {
    return benchmark::CaseFiles{settings.fullDem ? "" : "solid", true};
  };
  return benchmark::runCase<Settings>("wave_propagation", argc, argv, filesOf, readReferenceCurves, studiesText);
}
