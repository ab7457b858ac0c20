// The state of a model between static steps, in bytes.
#pragma once

#include "dovetail/core/archive.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem {

/// Time, displacements, velocities and what the terms remember: a static run that goes on from it has the same digits.
/// (Integrators save their own: they know more.)
void save(const Model& model, ByteWriter& archive);
/// @throws InputError if the state is that of another kind of run or model, is damaged, not finite, or not all of the
///         archive; the model is then as it was
void load(Model& model, ByteReader& archive);

}  // namespace dovetail::fem
