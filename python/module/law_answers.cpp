// What a contact law of Python's is given, and what it answers.
#include <cmath>

#include "called_laws.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::python {

namespace {

constexpr py::ssize_t number = sizeof(double);

struct Answer {
  const char* name;
  std::size_t column, width;
};
constexpr std::array<Answer, 6> known{{{"force", Batch::force, 3},
                                       {"couple", Batch::couple, 3},
                                       {"elastic_energy", Batch::elastic, 1},
                                       {"tangential_energy", Batch::tangential, 1},
                                       {"dissipated_power", Batch::dissipated, 1},
                                       {"friction_power", Batch::friction, 1}}};

std::string shapeOf(const py::array& a) {
  std::string text = "(";
  for (py::ssize_t k = 0; k < a.ndim(); ++k) text += (k > 0 ? ", " : "") + std::to_string(a.shape(k));
  return text + ")";
}

std::string grainsOf(const ContactsView& c, std::size_t k) {
  const auto idOf = [&](int i) { return std::to_string(c.particles->id[static_cast<std::size_t>(i)]); };
  const int second = c.batch->second[k];
  if (second < 0) return "of grain " + idOf(c.batch->first[k]) + " with a wall or solid";
  return "of grains " + idOf(c.batch->first[k]) + " and " + idOf(second);
}

void requireFinite(const double* column, const ContactsView& c, const std::string& what, const std::string& law) {
  for (std::size_t k = 0; k < c.batch->count; ++k)
    if (!std::isfinite(column[k]))
      throw InputError("its " + what + " at the contact " + grainsOf(c, k) + " is not finite", law,
                       "give finite numbers");
}

Values valuesOf(const py::handle& given, const std::string& what, const std::string& law) {
  Values values = Values::ensure(given);
  if (values) return values;
  PyErr_Clear();
  throw InputError("its " + what + " is no array of numbers", law, "give a numpy array");
}

/// Copies (N, width); (N) along the normals where a vector is asked for.
void take(const py::handle& given, const Answer& answer, const ContactsView& c, const std::string& law) {
  Batch& batch = *c.batch;
  const Values values = valuesOf(given, answer.name, law);
  const auto n = static_cast<py::ssize_t>(batch.count);
  const bool whole = answer.width == 3 && values.ndim() == 2 && values.shape(0) == n && values.shape(1) == 3;
  if (!whole && !(values.ndim() == 1 && values.shape(0) == n))
    throw InputError("the shape of its " + std::string(answer.name) + " is " + shapeOf(values), law,
                     "give (" + std::to_string(n) + ")" +
                         (answer.width == 3 ? ", along the normals, or (" + std::to_string(n) + ", 3)" : ""));
  for (std::size_t d = 0; d < answer.width; ++d) {
    double* const to = batch.answerColumn(answer.column + d);
    const double* const normal = batch.givenColumn(Batch::normal + d);
    for (py::ssize_t k = 0; k < n; ++k)
      to[k] = whole               ? *values.data(k, static_cast<py::ssize_t>(d))
              : answer.width == 3 ? *values.data(k) * normal[k]
                                  : *values.data(k);
    requireFinite(to, c, answer.name, law);
  }
}

void requireKnown(const py::dict& answers, const std::string& law) {
  for (const auto& [key, value] : answers) {
    const auto name = py::cast<std::string>(py::str(key));
    if (std::ranges::none_of(known, [&](const Answer& one) { return name == one.name; }))
      throw InputError("there is no answer \"" + name + "\"", law,
                       "give force, couple, elastic_energy, tangential_energy, dissipated_power or friction_power");
  }
  if (!answers.contains("force")) throw InputError("it answers no force", law, "give {\"force\": …}");
}

}  // namespace

py::array ContactsView::column(const py::object& self, std::size_t c) const {
  const auto n = static_cast<py::ssize_t>(batch->count);
  return py::array_t<double>({n}, {number}, batch->givenColumn(c), self);
}

py::array ContactsView::matrix(const py::object& self, std::size_t first, std::size_t width) const {
  const auto n = static_cast<py::ssize_t>(batch->count), m = static_cast<py::ssize_t>(width);
  return py::array_t<double>({n, m}, {number, n * number}, batch->givenColumn(first), self);
}

py::array_t<std::int64_t> ContactsView::ids(const std::vector<int>& numbers) const {
  if (!particles)
    throw InputError("the step of these contacts is over", "contacts", "ask for grains while the law is asked");
  py::array_t<std::int64_t> some(static_cast<py::ssize_t>(numbers.size()));
  std::int64_t* to = some.mutable_data();
  for (const int i : numbers) *to++ = i < 0 ? -1 : particles->id[static_cast<std::size_t>(i)];
  return some;
}

py::array_t<double> ContactsView::seen(const Values& slope) const {
  const auto n = static_cast<py::ssize_t>(batch->count);
  const bool one = slope.size() == 1;
  if (!one && !(slope.ndim() == 1 && slope.shape(0) == n))
    throw InputError("the shape of a slope is " + shapeOf(slope), "contacts", "give (" + std::to_string(n) + ")");
  py::array_t<double> found(n);
  double* const to = found.mutable_data();
  dem::Contact contact;
  contact.dt = batch->dt;
  contact.inverseDt = batch->dt > 0.0 ? 1.0 / batch->dt : 0.0;
  for (py::ssize_t k = 0; k < n; ++k) {
    const double mass = batch->givenColumn(Batch::mass)[k];
    contact.separating = batch->givenColumn(Batch::separating)[k];
    contact.separated = batch->givenColumn(Batch::separated)[k];
    contact.inverseMass = mass > 0.0 ? 1.0 / mass : 0.0;
    to[k] = dem::seenBy(contact, slope.data()[one ? 0 : k]);
  }
  return found;
}

void ContactsView::remember(const Values& values) const {
  const auto n = static_cast<py::ssize_t>(batch->count), numbers = static_cast<py::ssize_t>(memory);
  if (values.ndim() != 2 || values.shape(0) != n || values.shape(1) != numbers)
    throw InputError("the shape is " + shapeOf(values), "memory of contacts",
                     "give (" + std::to_string(n) + ", " + std::to_string(numbers) + ")");
  for (py::ssize_t c = 0; c < numbers; ++c) {
    double* const to = batch->givenColumn(Batch::memory + static_cast<std::size_t>(c));
    for (py::ssize_t k = 0; k < n; ++k) to[k] = *values.data(k, c);
  }
}

bool takeAnswers(const py::object& answer, const ContactsView& contacts, const std::string& name) {
  const bool several = py::isinstance<py::dict>(answer);
  bool energies = false;
  if (several) {
    const auto answers = py::reinterpret_borrow<py::dict>(answer);
    requireKnown(answers, name);
    for (const Answer& one : known)
      if (answers.contains(one.name)) take(answers[one.name], one, contacts, name);
    energies = answers.contains("elastic_energy");
  } else {
    take(answer, known[0], contacts, name);
  }
  for (int c = 0; c < contacts.memory; ++c)
    requireFinite(contacts.batch->givenColumn(Batch::memory + static_cast<std::size_t>(c)), contacts,
                  "memory " + std::to_string(c), name);
  return energies;
}

}  // namespace dovetail::python
