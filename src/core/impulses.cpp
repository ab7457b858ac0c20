#include "dovetail/core/impulses.hpp"

#include <algorithm>
#include <cstdint>

namespace dovetail {

void ImpulseLedger::Channel::give(const Momenta& impulse) {
  given += impulse;
  turnedOver += norm(impulse.linear);
  turnedOverAngular += norm(impulse.angular);
}

void ImpulseLedger::Channel::add(const Channel& other) {
  given += other.given;
  turnedOver += other.turnedOver;
  turnedOverAngular += other.turnedOverAngular;
}

ImpulseLedger::Channel& ImpulseLedger::channel(const std::string& name) {
  const auto found = std::ranges::find(channels_, name, &Channel::name);
  return found != channels_.end() ? *found : channels_.emplace_back(Channel{name, {}});
}

void ImpulseLedger::give(const std::string& name, const Momenta& impulse) {
  if (impulse != Momenta{}) channel(name).give(impulse);
}

void ImpulseLedger::give(const std::string& name, const Momenta& impulse, int& number) {
  if (impulse == Momenta{}) return;
  auto at = static_cast<std::size_t>(number);
  if (number < 0 || at >= channels_.size() || channels_[at].name != name) {
    at = static_cast<std::size_t>(&channel(name) - channels_.data());
    number = static_cast<int>(at);
  }
  channels_[at].give(impulse);
}

void ImpulseLedger::add(const std::string& prefix, const ImpulseLedger& other) {
  for (const Channel& from : other.channels_) channel(prefix + from.name).add(from);
}

ImpulseLedger::Channel ImpulseLedger::total() const {
  Channel sum{"total", {}};
  for (const Channel& one : channels_) sum.add(one);
  return sum;
}

void ImpulseLedger::save(ByteWriter& archive) const {
  archive(static_cast<std::uint64_t>(channels_.size()));
  for (const Channel& one : channels_) archive(one.name, one.given, one.turnedOver, one.turnedOverAngular);
}

void ImpulseLedger::load(ByteReader& archive) {
  std::uint64_t count = 0;
  archive(count);
  std::vector<Channel> read;
  for (std::uint64_t k = 0; k < count; ++k) {
    Channel one;
    archive(one.name, one.given, one.turnedOver, one.turnedOverAngular);
    read.push_back(std::move(one));
  }
  channels_ = std::move(read);
}

}  // namespace dovetail
