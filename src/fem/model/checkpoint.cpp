#include "dovetail/fem/model/checkpoint.hpp"

#include "../motion/run_state.hpp"

namespace dovetail::fem {

namespace {
constexpr const char* kind = "equilibrium";
}

void save(const Model& model, ByteWriter& archive) { detail::writeModel(archive, kind, model); }

void load(Model& model, ByteReader& archive) {
  detail::ModelState state = detail::readModel(archive, kind, model);
  detail::requireEnd(archive, "load");
  detail::adopt(std::move(state), model);
}

}  // namespace dovetail::fem
