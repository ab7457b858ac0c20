// One instantiation of each law of a list: makes the files beside this one.
#pragma once

#include "dovetail/dem/laws/own_laws.hpp"

#define DOVETAIL_COMPILE_LAW(...) \
  template std::shared_ptr<const ContactLaws> compiledLaws<__VA_ARGS__>(PreparedLaws<__VA_ARGS__>, std::string)
