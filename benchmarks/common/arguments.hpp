// Arguments of programs that have no options.
#pragma once

#include <charconv>
#include <cstring>
#include <limits>
#include <string>

#include "dovetail/core/error.hpp"

namespace dovetail::benchmark {

/// @throws InputError if there are more than `most` arguments; `usage` tells what to write
inline void requireAtMost(int most, int argc, char** argv, const std::string& usage) {
  if (argc - 1 > most)
    throw InputError("the argument '" + std::string(argv[most + 1]) + "' is not known", "command line", usage);
}

/// The argument of that number, `otherwise` if it is left out. @throws InputError unless it is a positive number
template <class Number>
Number positiveArgument(int number, Number otherwise, int argc, char** argv, const std::string& usage) {
  if (argc <= number) return otherwise;
  Number value{};
  const char* end = argv[number] + std::strlen(argv[number]);
  const auto [rest, error] = std::from_chars(argv[number], end, value);
  if (error != std::errc{} || rest != end || !(value > 0) || value > std::numeric_limits<Number>::max())
    throw InputError("'" + std::string(argv[number]) + "' is no positive number", "command line", usage);
  return value;
}

}  // namespace dovetail::benchmark
