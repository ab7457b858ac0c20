// Cases of material points with exact or published answers.
#pragma once

#include <string>

namespace dovetail::benchmark {

struct Case {
  std::string name;  ///< as --only takes it
  std::string what;
  bool (*run)(bool quick);  ///< prints a table; @return whether all that is judged holds
};

// One source file each.
bool bands(bool quick);
bool bar(bool quick);
bool block(bool quick);
bool cantilever(bool quick);
bool cells(bool quick);
bool column(bool quick);
bool discs(bool quick);
bool footing(bool quick);
bool rebound(bool quick);
bool runOut(bool quick);
bool speed(bool quick);
bool stability(bool quick);
bool stretch(bool quick);
bool vortex(bool quick);

}  // namespace dovetail::benchmark
