#include "dovetail/core/profile.hpp"

#include <iomanip>
#include <ostream>
#include <string_view>

namespace dovetail {

void Profile::add(const char* name, double seconds) {
  for (Row& row : rows_)
    if (row.name == std::string_view(name)) {
      row.seconds += seconds;
      ++row.calls;
      return;
    }
  rows_.push_back({name, seconds, 1});
}

std::ostream& operator<<(std::ostream& out, const Profile& profile) {
  if (profile.rows().empty()) return out;
  double total = 0.0;
  for (const auto& row : profile.rows()) total += row.seconds;
  const auto flags = out.flags();
  const auto precision = out.precision(4);
  out << "  " << std::left << std::setw(28) << "stage" << std::right << std::setw(12) << "seconds" << std::setw(10)
      << "fraction" << std::setw(14) << "us per call" << '\n';
  for (const auto& row : profile.rows())
    out << "  " << std::left << std::setw(28) << row.name << std::right << std::setw(12) << row.seconds << std::setw(8)
        << std::setprecision(3) << 100.0 * row.seconds / total << " %" << std::setw(14) << std::setprecision(4)
        << 1e6 * row.seconds / static_cast<double>(row.calls) << '\n';
  out.flags(flags);
  out.precision(precision);
  return out;
}

}  // namespace dovetail
