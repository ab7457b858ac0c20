// The known name that a misspelt one is likely to mean.
#pragma once

#include <string>
#include <vector>

namespace dovetail {

/// The candidate with the fewest changes of letters (insert, drop, exchange, swap neighbours; case, '_' and '-' do not
/// count), if they are no more than a third of the longer one's; else empty.
std::string nearest(const std::string& name, const std::vector<std::string>& candidates);

/// "write \"radius\"", or "write one of \"a\", \"b\"".
std::string adviceFor(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace dovetail
