#include "compiled_laws.hpp"

#include <dlfcn.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"

namespace dovetail::python {

namespace {

/// Passes all on; the name tells whose law it is.
class NamedLaws final : public dem::ContactLaws {
public:
  NamedLaws(std::string name, std::shared_ptr<const dem::ContactLaws> laws)
      : name_(std::move(name)), laws_(std::move(laws)) {}

  dem::ContactWork pairs(dem::Particles& particles, dem::PairList& list, double dt,
                         dem::Booking booking) const override {
    return laws_->pairs(particles, list, dt, booking);
  }
  dem::ContactWork wall(dem::Particles& particles, dem::PrimitiveWall& wall, double dt,
                        dem::Booking booking) const override {
    return laws_->wall(particles, wall, dt, booking);
  }
  dem::ContactWork wall(dem::Particles& particles, const dem::TriangulatedWall& wall, dem::WallContacts& contacts,
                        double dt, dem::Booking booking) const override {
    return laws_->wall(particles, wall, contacts, dt, booking);
  }
  void addDemand(dem::ContactDemand& demand, const dem::Particles& particles, const dem::PairList& list,
                 double leastOverlap) const override {
    laws_->addDemand(demand, particles, list, leastOverlap);
  }
  void addDemand(dem::ContactDemand& demand, const dem::Particles& particles,
                 const dem::PrimitiveWall& wall) const override {
    laws_->addDemand(demand, particles, wall);
  }
  void addDemand(dem::ContactDemand& demand, const dem::Particles& particles, const dem::TriangulatedWall& wall,
                 const dem::WallContacts& contacts) const override {
    laws_->addDemand(demand, particles, wall, contacts);
  }
  dem::ContactSample sample(const dem::Particles& particles, const dem::PairList& list) const override {
    return laws_->sample(particles, list);
  }
  double held(const dem::EndedPairs& pairs) const override { return laws_->held(pairs); }
  int memory() const override { return laws_->memory(); }
  bool rotates() const override { return laws_->rotates(); }
  double reach() const override { return laws_->reach(); }
  int materials() const override { return laws_->materials(); }
  const std::string& name() const override { return name_; }
  void saveParameters(ByteWriter& writer) const override {
    writer(laws_->name());
    laws_->saveParameters(writer);
  }

private:
  std::string name_;
  std::shared_ptr<const dem::ContactLaws> laws_;
};

/// This module, which Python has opened for itself alone, for the libraries that are opened from now on.
void lendSymbols() {
  Dl_info here;
  if (dladdr(reinterpret_cast<const void*>(&lendSymbols), &here) != 0)
    dlopen(here.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL);
}

template <class Function>
Function* functionOf(void* library, const char* name) {
  return reinterpret_cast<Function*>(dlsym(library, name));
}

}  // namespace

dem::LawLibrary openLaws(const std::filesystem::path& file) {
  const std::string path = std::filesystem::absolute(file).string();
  lendSymbols();
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* const why = dlerror();
    throw InputError(std::string("the library cannot be opened: ") + (why ? why : "unknown"), path,
                     "build it with dovetail_add_laws");
  }
  auto* const interface = functionOf<const char*()>(library, "dovetailLawInterface");
  auto* const add = functionOf<void(dem::LawLibrary&)>(library, "dovetailAddLaws");
  if (!interface || !add)
    throw InputError("the library has no contact laws", path, "write DOVETAIL_LAWS in one of its sources");
  if (interface() != dem::lawInterface())
    throw InputError("the library was compiled with the headers of another version", path,
                     "compile it with those of this one");
  dem::LawLibrary laws;
  add(laws);
  return laws;
}

std::shared_ptr<const dem::ContactLaws> makeCompiled(const std::string& name, const dem::CompiledLaw& law,
                                                     const dem::LawParameters& parameters) {
  auto made = law.make(parameters);
  if (!made) throw InputError("the library makes no law", name, "return makeContactLaws(law)");
  if (made->materials() != 1)
    throw InputError("the library makes a table of laws", name, "give one law for all contacts");
  return std::make_shared<const NamedLaws>("own law " + name, std::move(made));
}

}  // namespace dovetail::python
