// A ladder of scenes from bare grains to everything, each with one thing more than the one before.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dovetail/coupling/run.hpp"

namespace dovetail::atlas {

struct Rung {
  std::string name;        ///< what it has more than the rung below
  std::string components;  ///< libraries of the project that it links, beside those below
};

/// In their order, the barest first.
const std::vector<Rung>& ladder();

/// The scene of a rung: a cube of spheres on a lattice, periodic in x and y, in the coupled run, not started.
/// @param edge  spheres along each edge
std::unique_ptr<coupling::CoupledRun> makeRung(std::size_t rung, int edge);

}  // namespace dovetail::atlas
