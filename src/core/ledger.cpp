#include "dovetail/core/ledger.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <utility>

#include "dovetail/core/error.hpp"

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
  const auto found = std::ranges::find(channels_, name, &Channel::name);
  return found == channels_.end() ? 0.0 : found->joules;
}

const EnergyLedger::Channel* EnergyLedger::find(std::string_view name, Kind kind) const {
  const auto found =
      std::ranges::find_if(channels_, [&](const Channel& one) { return one.kind == kind && one.name == name; });
  return found == channels_.end() ? nullptr : &*found;
}

void EnergyLedger::set(std::string_view name, Kind kind, double joules) {
  const Channel* const known = find(name, kind);
  if (!known && kind == Kind::booked && joules == 0.0) return;
  set(known ? static_cast<Id>(known - channels_.data()) : addChannel(std::string(name), kind), joules);
}

void EnergyLedger::add(std::string_view name, double joules) {
  if (joules == 0.0) return;
  const Channel* const known = find(name, Kind::booked);
  set(name, Kind::booked, known ? known->joules + joules : joules);
}

void EnergyLedger::save(ByteWriter& archive) const {
  archive(static_cast<std::int64_t>(channels_.size()));
  for (const Channel& channel : channels_)
    archive(channel.name, static_cast<std::int64_t>(channel.kind), channel.joules, channel.joulesAtOpening);
}

void EnergyLedger::load(ByteReader& archive) {
  EnergyLedger read;
  std::vector<double> now;
  std::int64_t count = 0;
  for (archive(count); static_cast<std::int64_t>(now.size()) < count;) {
    std::string name;
    std::int64_t kind = 0;
    double joules = 0.0, atOpening = 0.0;
    archive(name, kind, joules, atOpening);
    const bool booked = kind == static_cast<std::int64_t>(Kind::booked);
    if (!(booked || kind == static_cast<std::int64_t>(Kind::stored)) || !std::isfinite(joules + atOpening) ||
        (booked && read.find(name, Kind::booked)))
      throw InputError("the channel \"" + name + "\" is damaged", "ledger", "take an older checkpoint");
    read.set(read.addChannel(name, booked ? Kind::booked : Kind::stored), atOpening);
    now.push_back(joules);
  }
  read.open();
  for (Id id = 0; id < now.size(); ++id) read.set(id, now[id]);
  *this = std::move(read);
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
