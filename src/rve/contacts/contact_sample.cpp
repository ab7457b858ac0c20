#include "dovetail/rve/contact_sample.hpp"

#include "bonded.hpp"
#include "touching.hpp"

namespace dovetail::rve {

ContactSample sampleContacts(const Rve& cell) {
  ContactSample sample;
  const auto add = [&](std::size_t i, std::size_t j, const Vec3& branch, const Vec3& force, bool slides) {
    sample.first.push_back(static_cast<int>(i));
    sample.second.push_back(static_cast<int>(j));
    sample.branch.push_back(branch);
    sample.force.push_back(force);
    sample.slides.push_back(slides ? 1 : 0);
  };
  forEachTouch(cell, [&](const Touch& touch) {
    add(touch.i, touch.j, touch.branch, contactForce(cell, touch), isSliding(cell.springs, touch));
  });
  forEachBond(cell, [&](const BondTouch& bond) { add(bond.i, bond.j, bond.branch, bond.forceOnI(), false); });
  return sample;
}

}  // namespace dovetail::rve
