// One instantiation of each law of a list: makes the files beside this one.
#pragma once

#include "dovetail/dem/laws/own_laws.hpp"

namespace dovetail::dem::detail {

template <class Law>
std::shared_ptr<const ContactLaws> compiledLaws(PreparedLaws<Law> laws, std::string name) {
  return OwnLaws<Law>::make(std::move(laws), std::move(name));
}

}  // namespace dovetail::dem::detail

#define DOVETAIL_COMPILE_LAW(...) \
  template std::shared_ptr<const ContactLaws> compiledLaws<__VA_ARGS__>(PreparedLaws<__VA_ARGS__>, std::string)
