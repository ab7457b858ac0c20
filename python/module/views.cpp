// Arrays of the grains without a copy, while the run stands still.
#include <algorithm>
#include <cmath>
#include <map>

#include "dovetail/core/error.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace {

using dem::Particles;

/// What arrays that outlive their `with` keep in place of the run's own memory.
struct Kept {
  std::vector<Vec3> vectors;
  std::vector<double> numbers;
  std::vector<std::int64_t> ids;
};

/// One array of the particles, lent out.
struct Lent {
  py::capsule owner;  ///< base of all arrays that look at it; holds a Kept
  Kept* kept = nullptr;

  Lent() : kept(new Kept) {
    owner = py::capsule(kept, [](void* one) { delete static_cast<Kept*>(one); });
  }
  bool isHeldElsewhere() const { return owner.ref_count() > 1; }
};

const std::map<std::string, std::vector<Vec3> Particles::*> vectorFields{
    {"x", &Particles::x}, {"v", &Particles::v}, {"omega", &Particles::omega}, {"f", &Particles::f}};
const std::map<std::string, std::vector<double> Particles::*> numberFields{{"radius", &Particles::radius},
                                                                           {"mass", &Particles::mass}};

bool isWritable(const std::string& field) { return field == "v" || field == "omega"; }

template <class Number>
py::array readOnly(py::array_t<Number> array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

void requireFinite(const std::vector<Vec3>& all, const std::string& field) {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!std::isfinite(all[i].x) || !std::isfinite(all[i].y) || !std::isfinite(all[i].z))
      throw InputError("row " + std::to_string(i) + " of " + field + " is not finite", "views",
                       "give finite numbers; the run is as it was");
}

/// Locks the run from its making to close().
class Views {
public:
  explicit Views(SceneRun& run) : run_(run) {
    run.requireWhole();
    const Particles& p = run.run().grains.particles;
    for (std::size_t i = 0; i < p.size(); ++i)
      if (p.isMember(i))
        throw InputError(p.isOfSolid(i) ? "grains of this run stand for parts of a solid"
                                        : "grain " + std::to_string(p.id[i]) + " is part of a clump",
                         "views", "take the copies that the grains of the run have");
    held_ = &run.hold();
  }
  Views(const Views&) = delete;
  Views& operator=(const Views&) = delete;
  ~Views() {
    if (held_) end();
  }

  py::array array(const std::string& field) {
    if (!held_) throw InputError("these views are closed", "views", "open others by run.grains.views()");
    Particles& p = particles();
    const auto n = static_cast<py::ssize_t>(p.size());
    if (field == "id") return readOnly(py::array_t<std::int64_t>(n, p.id.data(), lend(field).owner));
    if (const auto found = numberFields.find(field); found != numberFields.end())
      return readOnly(py::array_t<double>(n, (p.*found->second).data(), lend(field).owner));
    std::vector<Vec3>& all = p.*vectorFields.at(field);
    if (all.empty() && n > 0)
      throw InputError("grains of this run do not spin", "views", "give them laws that exert torques");
    if (isWritable(field)) before_.try_emplace(field, all);
    double* const first = all.empty() ? nullptr : &all.front().x;
    py::array_t<double> array({n, py::ssize_t{3}}, first, lend(field).owner);
    return isWritable(field) ? py::array(array) : readOnly(std::move(array));
  }

  /// @param keeps  what has been written; else the run is as it was before
  void close(bool keeps) {
    if (!held_) return;
    std::map<std::string, std::vector<Vec3>> written = end();
    if (!keeps || written.empty()) return;
    for (const auto& [field, all] : written) requireFinite(all, field);
    run_.run().change([&] {
      for (auto& [field, all] : written) run_.run().grains.particles.*vectorFields.at(field) = std::move(all);
    });
  }

private:
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  Particles& particles() { return held_->run->grains.particles; }
  Lent& lend(const std::string& field) { return lent_[field]; }

  /// Takes the memory from under arrays that are still there, and puts what was before in the place of what has been
  /// written. @return that
  std::map<std::string, std::vector<Vec3>> end() {
    Particles& p = particles();
    std::map<std::string, std::vector<Vec3>> written;
    for (auto& [field, before] : before_) {
      std::vector<Vec3>& now = p.*vectorFields.at(field);
      if (!std::ranges::equal(now, before)) written[field] = now;
    }
    for (auto& [field, lent] : lent_)
      if (lent.isHeldElsewhere()) detach(field, *lent.kept);
    for (const auto& one : written) p.*vectorFields.at(one.first) = before_.at(one.first);
    lent_.clear();
    before_.clear();
    held_ = nullptr;
    run_.release();
    return written;
  }
  void detach(const std::string& field, Kept& kept) {
    Particles& p = particles();
    const auto detach = [](auto& own, auto& other) {
      other = std::move(own);
      own = other;
    };
    if (field == "id") return detach(p.id, kept.ids);
    if (const auto found = numberFields.find(field); found != numberFields.end())
      return detach(p.*found->second, kept.numbers);
    detach(p.*vectorFields.at(field), kept.vectors);
  }

  SceneRun& run_;
  scene::Built* held_ = nullptr;
  std::map<std::string, Lent> lent_;
  std::map<std::string, std::vector<Vec3>> before_;
};

}  // namespace

void bindViews(py::module_& m) {
  py::class_<Views>(m, "_Views", "Arrays of the grains of a locked run, without a copy.")
      .def(py::init([](SceneRun& run) { return std::make_unique<Views>(run); }), py::keep_alive<1, 2>())
      .def("array", &Views::array)
      .def("close", &Views::close);
}

}  // namespace dovetail::python
