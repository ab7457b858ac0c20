// Text for reports and tables.
#pragma once

#include <string>

namespace dovetail::report {

/// As std::printf, into a string of any length; the compiler checks pattern against values.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// A field of a CSV file: in quotation marks, those within doubled.
std::string quoted(const std::string& text);

}  // namespace dovetail::report
