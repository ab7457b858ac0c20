#include "own_law.hpp"

#include "dovetail/dem/laws/own_laws.hpp"

namespace dovetail::dem {

std::shared_ptr<const ContactLaws> makeOwnLaws(const ContactLaw<CubicSpring, MindlinSpring>& law) {
  return makeContactLaws(law);
}

}  // namespace dovetail::dem
