#include "renewal.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/support_kick.hpp"

namespace dovetail::fem::detail {

namespace {

Momenta momentaOf(const Nodes& nodes) {
  std::vector<Vec3> momentum(nodes.v.size());
  for (std::size_t n = 0; n < momentum.size(); ++n) momentum[n] = nodes.mass[n] * nodes.v[n];
  return fem::momentaOf(nodes, momentum);
}

}  // namespace

bool renewNodes(Model& model, ModelLedger& ledger, ImpulseLedger& impulses) {
  bool any = false;
  for (const auto& term : model.terms) {
    if (!term->wantsOtherNodes(model.nodes)) continue;
    if (!model.constraints.empty())
      throw InputError("constraints name nodes that are laid out anew", term->name(),
                       "hold material points by borders of their grid");
    const std::string name = "renewals of " + term->name();
    const Momenta before = momentaOf(model.nodes);
    ledger.add(name, term->renewNodes(model.nodes, model.t));
    impulses.give(name, momentaOf(model.nodes) - before);
    any = true;
  }
  return any;
}

}  // namespace dovetail::fem::detail
