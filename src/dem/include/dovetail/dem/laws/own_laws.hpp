// Compiles a law that the library does not list, in the file that includes this one and calls makeContactLaws. Let it
// be a file of its own, with -O3 -fno-math-errno -fno-trapping-math.
#pragma once

#include <limits>

#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "dovetail/dem/walls/wall_collide.hpp"

namespace dovetail::dem::detail {

template <class Law>
class PreparedContactLaws final : public ContactLaws {
public:
  PreparedContactLaws(PreparedLaws<Law> laws, std::string name) : laws_(std::move(laws)), name_(std::move(name)) {}

  ContactWork pairs(Particles& particles, PairList& list, double dt, Booking booking) const override {
    return collide(particles, list, laws_, dt, booking);
  }
  ContactWork wall(Particles& particles, PrimitiveWall& wall, double dt, Booking booking) const override {
    return collide(particles, wall, laws_, dt, booking);
  }
  ContactWork wall(Particles& particles, const TriangulatedWall& wall, WallContacts& contacts, double dt,
                   Booking booking) const override {
    return collide(particles, wall, contacts, laws_, dt, booking);
  }
  void addDemand(ContactDemand& demand, const Particles& particles, const PairList& list,
                 double leastOverlap) const override {
    addPairDemand(demand, particles, list, laws_, leastOverlap);
  }
  void addDemand(ContactDemand& demand, const Particles& particles, const PrimitiveWall& wall) const override {
    addWallDemand(demand, particles, wall.contacts, laws_, wall.material);
  }
  void addDemand(ContactDemand& demand, const Particles& particles, const TriangulatedWall& wall,
                 const WallContacts& contacts) const override {
    addWallDemand(demand, particles, contacts, laws_, wall.material, wall.mass);
  }
  ContactSample sample(const Particles& particles, const PairList& list) const override {
    return samplePairs(particles, list, laws_);
  }

  double held(const EndedPairs& pairs) const override { return endedWork(pairs, laws_).lostPower(); }

  int memory() const override { return Law::memory; }
  bool rotates() const override { return Law::rotates; }
  double reach() const override { return laws_.reach(); }
  int materials() const override { return laws_.materials; }
  const std::string& name() const override { return name_; }
  void saveParameters(ByteWriter& writer) const override { writer(laws_.materials, laws_.table); }

private:
  PreparedLaws<Law> laws_;
  std::string name_;
};

template <class Law>
struct OwnLaws {
  static std::shared_ptr<const ContactLaws> make(PreparedLaws<Law> laws, std::string name) {
    return std::make_shared<const PreparedContactLaws<Law>>(std::move(laws), std::move(name));
  }
};

}  // namespace dovetail::dem::detail
