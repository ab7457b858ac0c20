// Contact laws of one's own, called or compiled.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "called_laws.hpp"
#include "compiled_laws.hpp"
#include "dovetail/scene/laws_in_place.hpp"
#include "dovetail/scene/scene.hpp"

namespace dovetail::python {

namespace {

struct Laws {
  std::shared_ptr<const dem::ContactLaws> laws;

  bool lacksEnergies() const {
    const auto* const called = dynamic_cast<const CalledLaws*>(laws.get());
    return called && called->lacksEnergies();
  }
};

/// For `with`: a scene is built within.
struct InPlace {
  Laws laws;
  std::unique_ptr<scene::LawsInPlace> now;

  void enter() { now = std::make_unique<scene::LawsInPlace>(laws.laws); }
  void exit(const py::args&) { now.reset(); }
};

Laws called(const std::string& name, int memory, std::vector<int> tangential, bool rotates, double reach, bool damps,
            py::function function, py::function stiffness, std::map<std::string, double> parameters) {
  LawTraits traits{memory, std::move(tangential), rotates, damps, reach};
  return {std::make_shared<const CalledLaws>(name, std::move(traits), std::move(function), std::move(stiffness),
                                             std::move(parameters))};
}

/// A column as a property.
template <class Class>
void defColumn(Class& contacts, const char* name, std::size_t first, std::size_t width, const char* help) {
  const auto get = [first, width](const py::object& self) {
    const auto& c = py::cast<const ContactsView&>(self);
    return width == 1 ? c.column(self, first) : c.matrix(self, first, width);
  };
  contacts.def_property_readonly(name, get, help);
}

void bindContacts(py::module_& m) {
  py::class_<ContactsView> contacts(m, "Contacts",
                                    "All contacts of a sweep, one row each: pairs of grains, or grains "
                                    "with one wall or solid. `first` is a grain.");
  contacts.def("__len__", [](const ContactsView& c) { return c.batch->count; });
  contacts.def_property_readonly(
      "dt", [](const ContactsView& c) { return c.batch->dt; }, "Step over which memories advance, s.");
  defColumn(contacts, "overlap", Batch::overlap, 1, "m, > 0 where they touch; (N).");
  defColumn(contacts, "overlap_before", Batch::overlapBefore, 1, "One step ago, m; < 0: they were apart; (N).");
  defColumn(
      contacts, "separating", Batch::separating, 1,
      "Velocity of the first relative to the second along the normal, m/s, > 0 while the overlap closes; of laws with "
      "`damping` at this instant, as `slip` and `spin`, else in the half step before; (N).");
  defColumn(contacts, "effective_mass", Batch::mass, 1, "m1 m2/(m1 + m2), kg; with a wall that of the grain; (N).");
  defColumn(contacts, "effective_radius", Batch::radius, 1, "R1 R2/(R1 + R2), m; with a wall the grain's; (N).");
  defColumn(contacts, "normal", Batch::normal, 3, "Unit, from the second to the first; (N, 3).");
  defColumn(contacts, "slip", Batch::slip, 3,
            "Tangential velocity of the first relative to the second at the contact, m/s; (N, 3).");
  defColumn(contacts, "spin", Batch::spin, 3, "Angular velocity of the first minus the second's, rad/s; (N, 3).");
  defColumn(contacts, "slipped", Batch::slipped, 3,
            "Tangential displacement in this step, while they touched, m: what springs are stretched by; (N, 3).");
  defColumn(contacts, "turned", Batch::turned, 3, "Relative rotation in this step, while they touched, rad; (N, 3).");
  defColumn(
      contacts, "engagement", Batch::engagement, 1,
      "Factor on a dashpot, which is there at once when two touch: 1, and in that step the time that it lasts over "
      "dt; (N).");
  defColumn(contacts, "engagement_until_end", Batch::engagementUntilEnd, 1,
            "The same of a force that also ends at once, as one that pulls; (N).");
  contacts.def(
      "seen", [](const ContactsView& c, const Values& slope) { return c.seen(slope); }, py::arg("slope"),
      "`separating` as the dashpot beside a spring sees it, which has changed it by its slope (N/m) since; m/s, (N).");
  contacts.def_property(
      "memory",
      [](const py::object& self) {
        const auto& c = py::cast<const ContactsView&>(self);
        return c.matrix(self, Batch::memory, static_cast<std::size_t>(c.memory));
      },
      [](const ContactsView& c, const Values& memory) { c.remember(memory); },
      "What each contact remembers, to be changed in place or set; 0 in a new one; (N, numbers).");
  contacts.def_property_readonly(
      "first", [](const ContactsView& c) { return c.ids(c.batch->first); }, "Ids of grains; (N).");
  contacts.def_property_readonly(
      "second", [](const ContactsView& c) { return c.ids(c.batch->second); }, "Ids, -1: a wall or a solid; (N).");
}

}  // namespace

void bindOwnLaws(py::module_& m) {
  bindContacts(m);
  py::class_<Laws>(m, "_Laws")
      .def_property_readonly("_lacks_energies", &Laws::lacksEnergies, "Whether it has answered without energies.");
  m.def("_called_laws", &called);
  py::class_<InPlace>(m, "_LawsInPlace")
      .def(py::init([](const Laws& laws) {
        return InPlace{laws, nullptr};
      }))
      .def("__enter__", &InPlace::enter)
      .def("__exit__", &InPlace::exit);
  m.def("_without_contact", [](const scene::Scene& one) { return scene::withoutContact(one); });
  py::class_<dem::CompiledLaw>(m, "_CompiledLaw")
      .def_readonly("_parameters", &dem::CompiledLaw::defaults, "All that it knows, SI.")
      .def("_make", [](const dem::CompiledLaw& law, const std::string& name, const dem::LawParameters& parameters) {
        return Laws{makeCompiled(name, law, parameters)};
      });
  m.def("_open_laws", [](const std::filesystem::path& file) { return openLaws(file).laws; });
}

}  // namespace dovetail::python
