#include "dovetail/scene/laws_in_place.hpp"

#include <cmath>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "dovetail/scene/scene.hpp"
#include "sizes.hpp"

namespace dovetail::scene {

namespace {

std::shared_ptr<const dem::ContactLaws>& now() {
  static thread_local std::shared_ptr<const dem::ContactLaws> laws;
  return laws;
}

[[noreturn]] void refuse(const std::string& what, const std::string& where, const std::string& remedy) {
  throw InputError(what + ", and one law is to stand for all contacts", where, remedy);
}

}  // namespace

LawsInPlace::LawsInPlace(std::shared_ptr<const dem::ContactLaws> laws)
    : before_(std::exchange(now(), std::move(laws))) {}
LawsInPlace::~LawsInPlace() { now() = std::move(before_); }

std::shared_ptr<const dem::ContactLaws> lawsInPlace() { return now(); }

Scene withoutContact(Scene scene) {
  if (!scene.contacts.empty())
    refuse("the scene has laws by pairs of contact materials", scene.contacts.front().law.where,
           "leave contacts and contact_material out");
  const auto* const linear = scene.contact ? std::get_if<LinearContact>(&scene.contact->normal) : nullptr;
  if (linear && linear->bonded)
    refuse("the scene's grains hold together by bonded springs", scene.contact->where,
           "leave bonded out, or give the scene bonds");
  for (const Stage& stage : scene.stages)
    if (stage.changes && (stage.changes->contact || !stage.changes->contacts.empty()))
      refuse("a stage changes the law", stage.where, "leave contact out of the changes");
  scene.contact.reset();
  return scene;
}

double impactInPlace(const Scene& scene, const dem::Particles& particles) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const auto laws = lawsInPlace();
  double mass = none, radius = 0.0;
  const auto offer = [&](double m, double r) {
    if (m < mass) mass = m, radius = r;
  };
  for (std::size_t i = 0; i < particles.size(); ++i) offer(particles.mass[i], particles.radius[i]);
  for (const Insertion& in : scene.insertions) offer(enteringOf(in).lightest, enteringOf(in).smallest);
  if (!laws || !std::isfinite(mass)) return none;
  dem::Particles two;
  for (const double x : {0.0, 1.95 * radius}) dem::addParticle(two, {x, 0.0, 0.0}, {}, radius, dem::Mass{mass});
  dem::PairList list;
  list.setSkin(0.0);
  dem::findPairs(two, list);
  dem::ContactDemand demand;
  laws->addDemand(demand, two, list, 0.0);
  return demand.links.empty() ? none : 2.0 * std::sqrt(0.5 * mass / demand.links.front().stiffness);
}

}  // namespace dovetail::scene
