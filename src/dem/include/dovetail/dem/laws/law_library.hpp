// Contact laws compiled into a library of their own, which whoever runs scenes loads by name (dv.load_laws):
//
//     #include "dovetail/dem/laws/law_library.hpp"
//     #include "dovetail/dem/laws/own_laws.hpp"
//
//     DOVETAIL_LAWS(library) {
//       using namespace dovetail::dem;
//       library.add("softening", {{"stiffness", 1e5}, {"friction", 0.3}}, [](const LawParameters& p) {
//         return makeContactLaws(ContactLaw<Softening, TangentialSpring>{
//             {p.at("stiffness")}, {.stiffness = 2.0 / 7.0 * p.at("stiffness"), .friction = p.at("friction")}});
//       });
//     }
//
// It takes all else of Dovetail from the program that loads it, and links nothing itself (DovetailOwnLaws.cmake).
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/laws/contact_block.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "dovetail/dem/walls/wall_contacts.hpp"

namespace dovetail::dem {

/// Numbers in SI units by their names.
using LawParameters = std::map<std::string, double>;

/// A law that parameters are still to be given to.
struct CompiledLaw {
  LawParameters defaults;  ///< all that it knows
  std::function<std::shared_ptr<const ContactLaws>(const LawParameters&)> make;
};

/// The laws of a library by their names.
struct LawLibrary {
  std::map<std::string, CompiledLaw> laws;

  /// @throws InputError for a name that is there, or none
  void add(const std::string& name, LawParameters defaults,
           std::function<std::shared_ptr<const ContactLaws>(const LawParameters&)> make) {
    if (name.empty()) throw InputError("a law has no name", "library of contact laws", "give it one");
    if (!laws.emplace(name, CompiledLaw{std::move(defaults), std::move(make)}).second)
      throw InputError("the law \"" + name + "\" is there twice", "library of contact laws", "rename one of them");
  }
};

/// What both sides must have in common: headers of one version, and the same compiler's layout of what they share.
inline std::string lawInterface() {
  std::ostringstream text;
  for (const std::size_t size :
       {sizeof(Particles), sizeof(PairList), sizeof(PrimitiveWall), sizeof(TriangulatedWall), sizeof(WallContacts),
        sizeof(detail::ContactBlock), sizeof(detail::PairRows), sizeof(ContactWork), sizeof(LawLibrary)})
    text << size << ' ';
  return text.str();
}

}  // namespace dovetail::dem

/// The body of the function that a library of laws is asked for its laws with.
#define DOVETAIL_LAWS(library)                                                                        \
  extern "C" __attribute__((visibility("default"))) const char* dovetailLawInterface() {              \
    static const std::string text = dovetail::dem::lawInterface();                                    \
    return text.c_str();                                                                              \
  }                                                                                                   \
  extern "C" __attribute__((visibility("default"))) void dovetailAddLaws(dovetail::dem::LawLibrary&); \
  void dovetailAddLaws(dovetail::dem::LawLibrary& library)
