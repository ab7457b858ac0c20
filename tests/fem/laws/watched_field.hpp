// Fields of points that are watched, and a bar of them.
#pragma once

#include <algorithm>

#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "plastic_laws.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {

inline const J2Plasticity metal{1e7, 0.3, 1000.0, linearYield(2e4, 1e5), 5e4};

/// A law behind a field that counts and remembers what it is asked.
class Watched : public PointField {
public:
  explicit Watched(std::shared_ptr<PointField> inner) : inner_(std::move(inner)) {}
  std::string name() const override { return inner_->name(); }
  double density() const override { return inner_->density(); }
  bool isSymmetric() const override { return inner_->isSymmetric(); }
  bool hasEnergy() const override { return inner_->hasEnergy(); }
  void open(std::span<const PointPlace> given) override {
    places.assign(given.begin(), given.end());
    inner_->open(given);
  }
  void evaluate(const FieldRequest& request) override {
    ++(request.moved ? states : tangentsAlone);
    energies += request.withEnergy ? 1 : 0;
    const std::pair state(std::vector<double>(request.F.begin(), request.F.end()), request.dt);
    if (request.moved) repeated += static_cast<int>(std::ranges::count(seen_, state));
    seen_.push_back(state);
    inner_->evaluate(request);
    if (spoil >= 0 && request.F[static_cast<std::size_t>(9 * spoil + 8)] > 1.05) {
      if (reason.empty())
        request.P[static_cast<std::size_t>(9 * spoil)] = std::nan("");
      else
        request.reason[static_cast<std::size_t>(spoil)] = reason;
    }
  }
  void commit() override { ++commits, seen_.clear(), inner_->commit(); }
  void revert() override { ++reverts, seen_.clear(), inner_->revert(); }
  void save(ByteWriter& archive) const override { inner_->save(archive); }
  void load(ByteReader& archive) override { inner_->load(archive); }

  std::vector<PointPlace> places;
  int states = 0, energies = 0, repeated = 0, tangentsAlone = 0, commits = 0, reverts = 0, spoil = -1;
  std::string reason;

private:
  std::shared_ptr<PointField> inner_;
  std::vector<std::pair<std::vector<double>, double>> seen_;  // since the last commit
};

inline SolidScene sceneOfField(const SolidMesh& mesh, std::shared_ptr<PointField> field, Formulation formulation) {
  SolidScene scene{makeModel(mesh), makeSolid(mesh, std::move(field), {.formulation = formulation})};
  scene.model.add(scene.solid);
  return scene;
}

/// A bar of two elements pulled along z.
struct Pulled {
  std::shared_ptr<Watched> field;
  SolidScene scene;
  explicit Pulled(std::shared_ptr<PointField> inner, double speed = 0.04)
      : field(std::make_shared<Watched>(std::move(inner))), scene(make(field, speed)) {}

  static SolidScene make(const std::shared_ptr<Watched>& field, double speed) {
    const SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 2}, {}, {0.1, 0.1, 0.2});
    SolidScene scene = sceneOfField(mesh, field, Formulation::standard);
    addMass(scene.model);
    scene.model.constraints.hold(nodeSet(mesh, "z-"));
    scene.model.constraints.prescribe(nodeSet(mesh, "z+"), 2, [speed](double t) { return speed * t; });
    return scene;
  }
};

}  // namespace dovetail::fem
