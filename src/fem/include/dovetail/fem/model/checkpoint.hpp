// The state of a model between static steps, in bytes.
#pragma once

#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem {

/// Time, displacements, velocities and what the terms remember: a static run that goes on from it has the same digits.
/// (Integrators save their own: they know more.)
void save(const Model& model, ByteWriter& archive);
/// @throws InputError if the state is that of another kind of run or model, is damaged, not finite, or not all of the
///         archive; the model is then as it was
void load(Model& model, ByteReader& archive);

/// Where the nodes of another run were, how fast, and what its terms remember.
struct SavedMotion {
  std::vector<Vec3> u, v;  ///< m, m/s
  struct OfTerm {
    std::string name;
    std::vector<char> bytes;
  };
  std::vector<OfTerm> terms;
};
/// What states of models begin with: those of save() and of all integrators.
/// @throws InputError if it is damaged or not finite
SavedMotion readMotion(ByteReader& archive);
/// The model goes on from there at its own time: with the displacements, the velocities and the memory of the elements;
/// loads and all else are its own.
/// @throws InputError if it has other nodes or elements; it is then as it was
void adopt(const SavedMotion& motion, Model& model);

}  // namespace dovetail::fem
