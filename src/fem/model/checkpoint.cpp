#include "dovetail/fem/model/checkpoint.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "motion/run_state.hpp"

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

SavedMotion readMotion(ByteReader& archive) {
  detail::readText(archive);  // the kind of run
  SavedMotion motion;
  for (std::int64_t left = detail::readCount(archive, "number of terms"); left > 0; --left)
    motion.terms.push_back({detail::readText(archive), {}});
  detail::readNumber(archive, "time");
  archive(motion.u, motion.v);
  if (motion.u.size() != motion.v.size())
    throw InputError("displacements and velocities are not of one number", "state", "take an older checkpoint");
  for (const auto* const field : {&motion.u, &motion.v})
    if (!std::ranges::all_of(*field, [](const Vec3& value) { return isFinite(value); }))
      throw InputError("a displacement or velocity is not finite", "state", "take an older checkpoint");
  for (SavedMotion::OfTerm& term : motion.terms) archive(term.bytes);
  return motion;
}

namespace {

const std::vector<char>& memoryOf(const SavedMotion& motion, const Term& elements) {
  const auto found = std::ranges::find(motion.terms, elements.name(), &SavedMotion::OfTerm::name);
  if (found == motion.terms.end())
    throw InputError("the state has no \"" + elements.name() + "\"", "adopt", "take the state of the same mesh");
  return found->bytes;
}

}  // namespace

void adopt(const SavedMotion& motion, Model& model) {
  if (motion.u.size() != model.nodes.u.size())
    throw InputError("the state has " + std::to_string(motion.u.size()) + " nodes, the model " +
                         std::to_string(model.nodes.u.size()),
                     "adopt", "take the state of the same mesh");
  detail::ModelState state{model.t, motion.u, motion.v, {}};
  for (const auto& term : model.terms) {
    ByteWriter own;
    term->save(own);
    state.terms.push_back(dynamic_cast<const Solid*>(term.get()) ? memoryOf(motion, *term) : own.bytes());
  }
  detail::adopt(std::move(state), model);
}

}  // namespace dovetail::fem
