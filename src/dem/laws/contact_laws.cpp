#include "dovetail/dem/laws/contact_laws.hpp"

namespace dovetail::dem {

bool sameLaws(const ContactLaws& a, const ContactLaws& b) {
  ByteWriter mine, others;
  a.saveParameters(mine);
  b.saveParameters(others);
  return a.name() == b.name() && mine.bytes() == others.bytes();
}

}  // namespace dovetail::dem
