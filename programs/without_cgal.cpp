#include "verbs.hpp"

namespace dovetail::program {

void offerTetrahedra() {}  // scenes that want them are refused with what to do

}  // namespace dovetail::program
