// Contact laws that no scene can name: of code that builds or runs one.
#pragma once

#include <memory>

#include "dovetail/dem/laws/contact_laws.hpp"

namespace dovetail::scene {

struct Scene;

/// While it lives, what this thread builds, checks and runs of scenes takes these laws for all contacts of grains, and
/// for surfaces of solids without a law of their own. Scenes then have no law themselves (requireNoLaws).
class LawsInPlace {
public:
  explicit LawsInPlace(std::shared_ptr<const dem::ContactLaws> laws);
  ~LawsInPlace();
  LawsInPlace(const LawsInPlace&) = delete;
  LawsInPlace& operator=(const LawsInPlace&) = delete;

private:
  std::shared_ptr<const dem::ContactLaws> before_;
};

/// Null if there are none.
std::shared_ptr<const dem::ContactLaws> lawsInPlace();

/// The scene without its own "contact".
/// @throws InputError for laws that other laws cannot stand for: by pairs of contact materials, bonded, or changing
Scene withoutContact(Scene scene);

/// 2/ω of two grains as light as the lightest that are or enter, pressed together by a twentieth of their radius under
/// the laws in place, s; infinite without.
double impactInPlace(const Scene& scene, const dem::Particles& particles);

}  // namespace dovetail::scene
