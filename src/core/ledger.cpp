#include "dovetail/core/ledger.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

namespace dovetail {

EnergyLedger::Id EnergyLedger::addChannel(std::string name, Kind kind) {
  channels_.push_back({std::move(name), kind});
  return channels_.size() - 1;
}

double EnergyLedger::sum(Kind kind) const {
  double total = 0.0;
  for (const Channel& channel : channels_)
    if (channel.kind == kind) total += channel.joules;
  return total;
}

void EnergyLedger::open() {
  for (Channel& channel : channels_) channel.joulesAtOpening = channel.joules;
  storedAtOpening_ = stored();
  bookedAtOpening_ = booked();
  storedMin_ = storedMax_ = storedAtOpening_;
  largestDrift_ = largestResidual_ = 0.0;
}

void EnergyLedger::close() {
  const double now = stored();
  storedMin_ = std::min(storedMin_, now);
  storedMax_ = std::max(storedMax_, now);
  largestDrift_ = std::max(largestDrift_, std::abs(now - storedAtOpening_));
  largestResidual_ = std::max(largestResidual_, std::abs(residual()));
}

double EnergyLedger::joules(std::string_view name) const {
  const auto found = std::ranges::find_if(channels_, [&](const Channel& channel) { return channel.name == name; });
  return found == channels_.end() ? 0.0 : found->joules;
}

double EnergyLedger::residual() const { return (stored() - storedAtOpening_) + (booked() - bookedAtOpening_); }

std::ostream& operator<<(std::ostream& out, const EnergyLedger& ledger) {
  const auto row = [&](const std::string& name, double opening, double now) {
    out << "  " << std::left << std::setw(34) << name << std::right << std::setw(14) << opening << std::setw(14) << now
        << std::setw(14) << now - opening << '\n';
  };
  const auto flags = out.flags();
  const auto precision = out.precision(6);
  out << "  " << std::left << std::setw(34) << "channel (J)" << std::right << std::setw(14) << "at opening"
      << std::setw(14) << "now" << std::setw(14) << "change" << '\n';
  for (const auto& channel : ledger.channels())
    row(channel.name + (channel.kind == EnergyLedger::Kind::booked ? " [booked]" : ""), channel.joulesAtOpening,
        channel.joules);
  row("stored total", ledger.storedAtOpening(), ledger.stored());
  out << "  " << std::left << std::setw(34) << "residual" << std::right << std::setw(42) << ledger.residual() << '\n';
  out.flags(flags);
  out.precision(precision);
  return out;
}

}  // namespace dovetail
