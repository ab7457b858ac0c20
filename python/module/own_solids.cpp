// Solids whose forces are functions of Python's.
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/linalg/largest_eigenvalue.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace {

using Integers = py::array_t<std::int64_t, py::array::c_style>;

/// A class of Python's, and what messages call it.
struct Own {
  std::shared_ptr<py::object> object;
  std::string name;

  bool has(const char* what) const { return py::hasattr(*object, what) && !object->attr(what).is_none(); }
  std::string where(const char* what) const { return "solid \"" + name + "\", " + what; }
  template <class T>
  T get(const char* what, const char* remedy) const {
    if (!has(what)) throw InputError(std::string("it has no ") + what, "solid \"" + name + "\"", remedy);
    const char* const told = "these are not the numbers that they should be";
    try {
      return py::cast<T>(object->attr(what));
    } catch (const py::cast_error&) {
      throw InputError(told, where(what), remedy);
    } catch (py::error_already_set& error) {
      if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError)) throw;
      throw InputError(told, where(what), remedy);
    }
  }
  std::vector<double> numbers(const char* what, std::size_t n, const char* remedy) const {
    const auto given = get<Numbers>(what, remedy);
    if (given.ndim() > 1 || (given.ndim() == 1 && static_cast<std::size_t>(given.size()) != n))
      throw InputError("there are " + std::to_string(given.size()) + " numbers for " + std::to_string(n) + " nodes",
                       where(what), remedy);
    std::vector<double> all(n);
    for (std::size_t k = 0; k < n; ++k) {
      all[k] = given.data()[given.ndim() == 0 ? 0 : k];
      if (!std::isfinite(all[k]))
        throw InputError("number " + std::to_string(k) + " is not finite", where(what), remedy);
    }
    return all;
  }
};

/// What the class does at its nodes.
class OwnForces final : public fem::Term {
public:
  OwnForces(Own own, std::vector<double> mass) : own_(std::move(own)), mass_(std::move(mass)) {
    hasEnergy_ = own_.has("energy");
    if (own_.has("critical_step")) limit_ = own_.get<double>("critical_step", "give 2/ω in s");
    if (limit_ && !(*limit_ > 0.0)) throw InputError("it is not > 0", own_.where("critical_step"), "give 2/ω in s");
  }

  std::string name() const override { return "own forces"; }
  void addForces(const fem::Nodes& nodes, const fem::Instant& now, std::span<Vec3> f) override {
    now_ = now.t;
    const std::vector<Vec3> own = forcesAt(now.t, nodes.u, nodes.v);
    for (std::size_t n = 0; n < own.size(); ++n) f[n] += own[n];
  }
  bool hasEnergy() const override { return hasEnergy_; }
  double energy(const fem::Nodes& nodes, const fem::Instant&) override {
    const py::gil_scoped_acquire lock;
    const double joules = py::cast<double>(own_.object->attr("energy")(arrayOf(nodes.u)));
    if (!std::isfinite(joules)) throw NumericalError("it is not finite", own_.where("energy"), "");
    return joules;
  }
  void addMass(std::span<double> mass) const override {
    for (std::size_t n = 0; n < mass.size(); ++n) mass[n] += mass_[n];
  }
  bool isBody() const override { return true; }
  void addStiffness(const fem::Nodes&, const fem::Instant&, std::span<double>) override {}
  std::optional<fem::StableStep> stableStep(const fem::Nodes& nodes) override {
    fem::StableStep limit;
    limit.dt = limit_ ? *limit_ : 2.0 / std::sqrt(largestRate(nodes));
    limit.element = 0;
    limit.solid = name();
    limit.part = "part";
    return limit;
  }

private:
  std::vector<Vec3> forcesAt(double t, const std::vector<Vec3>& u, const std::vector<Vec3>& v) const {
    const py::gil_scoped_acquire lock;
    return vectorsOf(py::cast<Numbers>(own_.object->attr("forces")(t, arrayOf(u), arrayOf(v))), mass_.size(),
                     own_.where("forces"));
  }

  /// ω² of the forces as they are, 1/s², by differences over a small part of the solid's extent.
  double largestRate(const fem::Nodes& nodes) const {
    constexpr double part = 1e-6, accuracy = 1e-2;
    geometry::Box box{nodes.X.front(), nodes.X.front()};
    for (const Vec3& X : nodes.X)
      for (int c = 0; c < 3; ++c)
        box.lower[c] = std::min(box.lower[c], X[c]), box.upper[c] = std::max(box.upper[c], X[c]);
    const double length = part * norm(box.upper - box.lower);
    const std::vector<Vec3> rest(nodes.X.size());
    const auto free = [&](std::size_t k) { return ((nodes.fixed[k / 3] >> (k % 3)) & 1U) == 0; };
    double stiffest = 0.0;  // N/m so far: what is far less is the round-off of the differences
    const auto stiffness = [&](std::span<const double> x, std::span<double> y) {
      constexpr double roundOff = 1e-7;
      double largest = 0.0, pull = 0.0;
      for (std::size_t k = 0; k < x.size(); ++k) largest = std::max(largest, free(k) ? std::abs(x[k]) : 0.0);
      std::ranges::fill(y, 0.0);
      if (largest == 0.0) return;
      std::vector<Vec3> ahead = nodes.u, behind = nodes.u;
      for (std::size_t k = 0; k < x.size(); ++k) {
        const double h = free(k) ? length / largest * x[k] : 0.0;
        ahead[k / 3][static_cast<int>(k % 3)] += h, behind[k / 3][static_cast<int>(k % 3)] -= h;
      }
      const std::vector<Vec3> a = forcesAt(now_, ahead, rest), b = forcesAt(now_, behind, rest);
      for (std::size_t k = 0; k < y.size(); ++k)
        if (free(k))
          pull =
              std::max(pull, std::abs(y[k] = 0.5 * largest / length * (b[k / 3] - a[k / 3])[static_cast<int>(k % 3)]));
      stiffest = std::max(stiffest, pull / largest);
      if (pull <= roundOff * stiffest * largest) std::ranges::fill(y, 0.0);
    };
    const auto times = [&](double power) {
      return [&, power](std::span<const double> x, std::span<double> y) {
        for (std::size_t k = 0; k < x.size(); ++k) y[k] = std::pow(nodes.mass[k / 3], power) * x[k];
      };
    };
    return linalg::largestEigenvalue({3 * nodes.X.size(), stiffness, times(1.0), times(-1.0)}, accuracy);
  }

  Own own_;
  std::vector<double> mass_;
  bool hasEnergy_ = false;
  std::optional<double> limit_;
  double now_ = 0.0;
};

std::vector<fem::Face> facesOf(const Own& own, std::size_t nodes) {
  constexpr const char* remedy =
      "give node numbers counter-clockwise from outside, an array of integers (M, 3), "
      "(M, 4), (M, 6), (M, 8) or (M, 9)";
  const auto rows = own.get<Integers>("faces", remedy);
  const py::ssize_t per = rows.ndim() == 2 ? rows.shape(1) : 0;
  std::vector<fem::Face> faces;
  for (const fem::FaceShape shape : {fem::FaceShape::tri3, fem::FaceShape::quad4, fem::FaceShape::tri6,
                                     fem::FaceShape::quad8, fem::FaceShape::quad9}) {
    if (fem::nodesOf(shape) != per) continue;
    const std::vector<int> all = numbersOf(rows, static_cast<std::size_t>(per), nodes, own.where("faces"));
    for (auto from = all.begin(); from != all.end(); from += per) {
      faces.push_back({shape, {-1, -1, -1, -1, -1, -1, -1, -1, -1}});
      std::copy_n(from, per, faces.back().node.begin());
    }
  }
  if (faces.empty()) throw InputError("these are no faces", own.where("faces"), remedy);
  return faces;
}

fem::SolidMesh meshOf(const Own& own, const std::vector<Vec3>& X) {
  constexpr const char* remedy =
      "give node numbers in VTK's order, an array of integers (M, 4), (M, 8), (M, 10), "
      "(M, 20) or (M, 27)";
  const auto rows = own.get<Integers>("cells", remedy);
  fem::SolidMesh mesh;
  mesh.X = X;
  for (const fem::ElementShape shape : fem::allCellShapes)
    if (fem::dimensionOf(shape) == 3 && rows.ndim() == 2 && fem::nodesOf(shape) == rows.shape(1))
      mesh.groups.push_back(
          {shape, numbersOf(rows, static_cast<std::size_t>(rows.shape(1)), X.size(), own.where("cells"))});
  if (mesh.groups.empty()) throw InputError("these are no cells", own.where("cells"), remedy);
  fem::validate(mesh);
  return mesh;
}

arlequin::CouplingOptions overlapOf(const Own& own) {
  arlequin::CouplingOptions options{.constraint = arlequin::ConstraintKind::multiplier};
  if (!own.has("overlap")) return options;
  for (const auto& [key, value] : own.get<py::dict>("overlap", "give a dict")) {
    const auto what = py::cast<std::string>(py::str(key)), word = py::cast<std::string>(py::str(value));
    if (what == "penalty")
      options.penalty = py::cast<double>(value);
    else if (what == "constraint" && word == "penalty")
      options.constraint = arlequin::ConstraintKind::penalty;
    else if (what != "constraint" || word != "multiplier")
      throw InputError("there is no \"" + what + "\": " + word, own.where("overlap"),
                       "give \"constraint\": \"multiplier\", or \"penalty\" and \"penalty\" in Pa/m2");
  }
  if ((options.constraint == arlequin::ConstraintKind::penalty) != (options.penalty > 0.0))
    throw InputError("a penalty has a number > 0, and a multiplier has none", own.where("overlap"),
                     "give \"constraint\": \"penalty\" with \"penalty\" in Pa/m2");
  return options;
}

void couple(scene::Built& built, coupling::SolidSide& side, const Own& own) {
  dem::Model& grains = built.run->grains;
  const std::vector<Vec3>& X = side.nodes().X;
  const bool overlaps = own.has("grain_weight");
  if (overlaps)
    grains.terms.add(arlequin::makeArlequinCoupling(
        grains, meshOf(own, X),
        own.numbers("grain_weight", X.size(), "give the fraction of the grains at each node, (N), from 0 to 1"), side,
        overlapOf(own)));
  if (!own.has("faces") && overlaps) return;
  const std::vector<fem::Face> faces =
      own.has("faces") || !own.has("cells") ? facesOf(own, X.size()) : fem::boundaryFaces(meshOf(own, X));
  grains.terms.add(surface::SurfaceContact(side, surface::SurfaceCoupler(surface::makeSkin(X, faces)), grains.laws,
                                           "grains on " + own.name));
}

void add(scene::Built& built, const Own& own) {
  if (!py::hasattr(*own.object, "forces"))
    throw InputError("it has no forces", "solid \"" + own.name + "\"", "give it a function forces(t, u, v), N, (N, 3)");
  const auto places = own.get<Numbers>("X", "give the places of its nodes, m, (N, 3)");
  fem::SolidMesh nodes;
  nodes.X = vectorsOf(places, places.ndim() == 2 ? static_cast<std::size_t>(places.shape(0)) : 0, own.where("X"));
  const std::size_t n = nodes.X.size();
  if (n == 0) throw InputError("it has no nodes", own.where("X"), "give their places, m, (N, 3)");
  auto model = std::make_unique<fem::Model>(fem::makeModel(nodes));
  std::vector<double> mass = own.numbers("mass", n, "give the masses of its nodes, kg, (N), or one number");
  if (const auto light = std::ranges::find_if(mass, [](double m) { return m <= 0.0; }); light != mass.end())
    throw InputError("node " + std::to_string(light - mass.begin()) + " has no mass", own.where("mass"), "give kg > 0");
  if (own.has("v")) model->nodes.v = vectorsOf(own.get<Numbers>("v", "give m/s, (N, 3)"), n, own.where("v"));
  if (own.has("held")) {
    const auto numbers = own.get<std::vector<int>>("held", "give numbers of nodes");
    fem::fix(model->nodes, numbers);
  }
  model->add(std::make_shared<OwnForces>(own, std::move(mass)));
  couple(built, built.run->addSolid(std::move(model), {.name = own.name}), own);
}

}  // namespace

void addOwnSolids(scene::Built& built, const py::dict& solids) {
  for (const auto& [name, solid] : solids)
    add(built, {held(py::reinterpret_borrow<py::object>(solid)), py::cast<std::string>(name)});
}

}  // namespace dovetail::python
