#include "common/case_program.hpp"
#include "run.hpp"
#include "texts.hpp"

int main(int argc, char** argv) {
  using namespace dovetail;
  using namespace dovetail::cantilever;
  const auto filesOf = [](const Settings&) { return benchmark::CaseFiles{"beam"}; };
  return benchmark::runCase<Settings>("cantilever", argc, argv, filesOf, readReferenceCurves, studiesText);
}
