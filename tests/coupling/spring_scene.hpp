// Particles on springs to the nodes of a block: the simplest connector there is.
#pragma once

#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"

namespace dovetail::coupling {

/// ½ k |x_particle − x_node|² each.
class Springs final : public Connector {
public:
  struct Spring {
    std::int64_t id;
    int node;
  };
  Springs(SolidSide& side, double stiffness, std::vector<Spring> springs)
      : Connector(side), stiffness_(stiffness), springs_(std::move(springs)) {}

  std::string name() const override { return "springs"; }
  std::string code() const override { return "springs"; }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<Springs>(*this); }
  void addForces(dem::Model& m, const dem::Step&) override {
    energy_ = 0.0;
    for (const Spring& spring : springs_) {
      const auto i = static_cast<std::size_t>(dem::find(m.particles, spring.id)),
                 n = static_cast<std::size_t>(spring.node);
      const Vec3 gap = m.particles.x[i] - side().nodes().X[n] - side().nodes().u[n];
      m.particles.f[i] -= stiffness_ * gap;
      side().load.add(spring.node, stiffness_ * gap);
      energy_ += 0.5 * stiffness_ * squaredNorm(gap);
    }
  }
  void addDemand(const dem::Model& m, dem::ContactDemand& demand) const override {
    demand.stiffness.resize(m.particles.size(), 0.0);
    demand.damping.resize(m.particles.size(), 0.0);
    const int side = this->side().addTo(demand);
    for (const Spring& spring : springs_) {
      const int i = dem::find(m.particles, spring.id);
      demand.stiffness[static_cast<std::size_t>(i)] += stiffness_;
      const auto node = static_cast<int>(demand.sides[static_cast<std::size_t>(side)].first) + spring.node;
      const dem::ContactDemand::Fraction whole{node, 1.0};
      demand.links.push_back({.particle = i,
                              .partner = -1,
                              .owner = dem::StepOwner::contact,
                              .shifting = stiffness_,
                              .side = side,
                              .shifted = demand.add({&whole, 1})});
    }
  }
  double stored() const override { return energy_; }
  void save(ByteWriter& archive) const override { archive(energy_); }
  void load(ByteReader& archive) override { archive(energy_); }

private:
  double stiffness_;
  std::vector<Spring> springs_;
  double energy_ = 0.0;
};

struct SpringSetup {
  Stepping stepping = Stepping::explicitSteps;
  double massFraction = 0.0;
  bool held = false;
  double stiffness = 2e4;  ///< N/m
};

inline std::unique_ptr<fem::Model> block(const fem::SolidMesh& mesh, bool held) {
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(fem::StVenantKirchhoff{1e6, 0.3, 1000.0}))));
  fem::addMass(*model);
  if (held) fem::fix(model->nodes, mesh.nodeSets.at("z-"));
  return model;
}

/// Four particles above a block of bricks, on springs to its top corners, in motion.
inline std::unique_ptr<CoupledRun> springRun(const SpringSetup& setup) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {2, 2, 2}, {0, 0, -0.2}, {0.2, 0.2, 0});
  auto run = std::make_unique<CoupledRun>();
  dem::ElasticLaw law;
  law.normal.stiffness = 1e4;
  run->grains.laws = dem::makeContactLaws(law);
  run->grains.pairs.setSkin(0.02);
  std::vector<Springs::Spring> springs;
  const std::vector<int>& top = mesh.nodeSets.at("z+");
  for (const std::size_t corner : {std::size_t{0}, std::size_t{2}, std::size_t{6}, std::size_t{8}}) {
    const Vec3 X = mesh.X[static_cast<std::size_t>(top[corner])];
    const auto k = static_cast<double>(springs.size());
    dem::addParticle(run->grains.particles, X + Vec3{0.002, -0.001 * k, 0.003}, {0.05, 0.02 * k, -0.1}, 0.03,
                     dem::Mass{0.3 + 0.1 * k});
    springs.push_back({static_cast<std::int64_t>(springs.size()), top[corner]});
  }
  SolidSide& side = run->addSolid(block(mesh, setup.held),
                                  {.name = "block", .stepping = setup.stepping, .massFraction = setup.massFraction});
  run->grains.terms.add(Springs(side, setup.stiffness, springs));
  return run;
}

}  // namespace dovetail::coupling
