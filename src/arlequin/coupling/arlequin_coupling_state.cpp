// What an overlap tie says of itself, and its state in bytes.
#include <algorithm>
#include <string>

#include "arlequin_coupling_impl.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::arlequin {

OverlapState ArlequinCoupling::state() const {
  OverlapState state = impl_->events;
  const Overlap& overlap = impl_->overlap;
  state.members = overlap.size();
  state.rows = impl_->rowNode.size();
  state.strangers = static_cast<std::int64_t>(impl_->strangers.size());
  std::vector<char> holds(impl_->setting.mesh.elementCount(), 0);
  for (const fem::CellPlace& place : overlap.place)
    if (place.element >= 0) holds[static_cast<std::size_t>(place.element)] = 1;
  for (std::size_t e = 0; e < holds.size(); ++e)
    if (!holds[e] && std::ranges::all_of(cellOf(impl_->setting.mesh, static_cast<int>(e)).corner(), [&](int n) {
          return impl_->setting.nodalWeight[static_cast<std::size_t>(n)] > 0.0;
        }))
      ++state.voids;
  return state;
}

namespace {

void exchangeState(auto& archive, auto& s, auto& element, auto& xi) {
  archive(s.overlap.particle, element, xi, s.overlap.x, s.overlap.weight, s.overlap.elements, s.weights.pairs, s.kept,
          s.now, s.increment, s.lambda, s.rowNode, s.nodesBefore, s.storedNow, s.lost, s.power, s.memberTravel,
          s.farTravel, s.near, s.setting.bulkDensity, s.meanRadius, s.largestRadius);
  archive(s.known, s.knownIds, s.events.relocations, s.events.admitted, s.events.removed, s.complies, s.macroIncrement,
          s.atMacroStep, s.macroTime, s.openingWork, s.absorbed, s.refit, s.strangers, s.events.firstStranger,
          s.events.strangerAt);
}

}  // namespace

void ArlequinCoupling::save(ByteWriter& writer) const {
  const Impl& s = *impl_;
  std::vector<int> element;
  std::vector<Vec3> xi;
  for (const fem::CellPlace& place : s.overlap.place) {
    element.push_back(place.element);
    xi.push_back(place.xi);
  }
  exchangeState(writer, s, element, xi);
}

void ArlequinCoupling::load(ByteReader& reader) {
  Impl& s = *impl_;
  std::vector<int> element;
  std::vector<Vec3> xi;
  exchangeState(reader, s, element, xi);
  const std::size_t members = s.overlap.particle.size();
  for (const std::size_t count : {element.size(), xi.size(), s.overlap.x.size(), s.overlap.weight.size()})
    if (count != members)
      throw InputError("the lists of a state do not fit each other", "overlap", "take an older checkpoint");
  for (const int number : element)
    if (number >= static_cast<int>(s.setting.mesh.elementCount()))
      throw InputError("there is no element " + std::to_string(number), "overlap", "take an older checkpoint");
  for (const int node : s.rowNode)
    if (node < 0 || static_cast<std::size_t>(node) >= s.setting.mesh.X.size())
      throw InputError("there is no node " + std::to_string(node), "overlap", "take an older checkpoint");
  s.overlap.place.assign(element.size(), {});
  for (std::size_t k = 0; k < element.size(); ++k)
    if (element[k] >= 0)
      s.overlap.place[k] = {element[k], xi[k], fem::shapeRow(cellOf(s.setting.mesh, element[k]).shape, xi[k])};
  s.stale = true;
  s.memberOf.clear();
}

}  // namespace dovetail::arlequin
