// Two particles fly into each other and apart again.
#include <iostream>

#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/pairs/pairs.hpp"

using namespace dovetail;

int main() {
  dem::Particles particles;
  dem::addParticle(particles, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.1, dem::Mass{1.0});
  dem::addParticle(particles, {0.3, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 0.1, dem::Mass{1.0});
  const auto law = dem::makeContactLaws(dem::ElasticLaw{{.stiffness = 1e4}});
  dem::PairList pairs;
  for (int step = 0; step < 2000; ++step) {
    dem::drift(particles, 5e-5);
    dem::clearForces(particles);
    dem::updatePairs(particles, pairs);
    law->pairs(particles, pairs, 1e-4, dem::Booking::off);
    dem::kick(particles, 1e-4);
    dem::drift(particles, 5e-5);
  }
  std::cout << particles.v[0].x << " " << particles.v[1].x << "\n";
  return particles.v[0].x < -0.99 && particles.v[1].x > 0.99 ? 0 : 1;
}
