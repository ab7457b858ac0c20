#include "dovetail/scene/series_row.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "build/parts.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "probes.hpp"
#include "series.hpp"

namespace dovetail::scene {

namespace {

/// "plate: work (minus)" → "plate_work_minus_J"
std::string columnOf(const std::string& channel) {
  std::string name;
  for (const char c : channel)
    if (std::isalnum(static_cast<unsigned char>(c)))
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  if (!name.empty() && name.back() == '_') name.pop_back();
  return name + "_J";
}

std::vector<const dem::BondTerm*> bondsOf(const Built& built) {
  return std::as_const(built.run->grains).terms.all<dem::BondTerm>();
}
bool grainsLeave(const Built& built) {
  const dem::Model& grains = built.run->grains;
  return !grains.terms.all<dem::OutletTerm>().empty() ||
         (grains.domain && grains.domain->policy == dem::EscapePolicy::remove);
}

/// What has come, gone and broken so far; columns as columnsOf names them.
void appendCounts(const Built& built, std::vector<double>& row) {
  if (const auto insertions = insertionsOf(built); !insertions.empty()) {
    double refused = 0.0, entered = 0.0, mass = 0.0;
    for (const dem::Insertion* const one : insertions) {
      refused += static_cast<double>(one->refused);
      entered += static_cast<double>(one->inserted);
      mass += one->insertedMass;
    }
    row.insert(row.end(), {refused, entered, mass});
  }
  const dem::Exchanged& left = built.run->grains.left;
  if (grainsLeave(built)) row.insert(row.end(), {static_cast<double>(left.count), left.mass});
  for (const dem::BondTerm* const term : bondsOf(built))
    row.insert(row.end(), {static_cast<double>(term->bonds.size()), static_cast<double>(term->bonds.brokenSoFar)});
}

std::vector<std::string> columnsOf(const std::vector<std::string>& channels, const Built& built, bool followsLoads,
                                   const std::vector<std::string>& probes) {
  std::vector<std::string> names{"time_s", "particles", "limit_s"};
  for (const std::string& channel : channels) names.push_back(columnOf(channel));
  for (const char* const name : {"others_J", "residual_J", "momentum_x_Ns", "momentum_y_Ns", "momentum_z_Ns",
                                 "given_x_Ns", "given_y_Ns", "given_z_Ns"})
    names.push_back(name);
  for (const auto& [solid, force] : forcesOnSolids(built))
    for (const char* const axis : {"_x_N", "_y_N", "_z_N"}) names.push_back("on_" + solid + axis);
  if (!insertionsOf(built).empty()) names.insert(names.end(), {"no_room", "entered", "entered_kg"});
  if (grainsLeave(built)) names.insert(names.end(), {"left", "left_kg"});
  if (!bondsOf(built).empty()) names.insert(names.end(), {"bonds", "bonds_broken"});
  for (std::size_t s = 0; followsLoads && s < built.run->solids(); ++s)
    names.push_back(built.run->solid(s).name + "_load_factor");
  names.insert(names.end(), probes.begin(), probes.end());
  return names;
}

bool followsLoads(const Scene& scene) {
  return std::ranges::any_of(scene.stages, [](const Stage& one) {
    const auto* const statics = std::get_if<Statics>(&one.kind);
    return statics && statics->arcLength;
  });
}

/// Channels of the run at its start, and those that it may come to have. @param loads  there are load steps
std::vector<std::string> channelsOf(const Built& built, bool loads, bool changes) {
  coupling::CoupledRun& run = *built.run;
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& channel : run.ledger().channels()) add(channel.name);
  for (const char* const later :
       {"dashpots", "friction", "rolling", "left", "entered (minus)", "work of walls and drives (minus)"})
    add(std::string("particles: ") + later);
  const dem::ContactLaws& laws = *run.grains.laws;
  const bool pullsApart = laws.reach() > 0.0 && !std::isinf(laws.reach());  // liquid bridges, which rupture
  if (pullsApart || !run.grains.terms.all<dem::BondTerm>().empty()) add("particles: fracture");
  if (laws.name().starts_with(dem::ElasticPlastic::name)) add("particles: plastic contacts");
  if (!run.grains.terms.all<dem::DampingTerm>().empty()) add("particles: damping");
  for (std::size_t s = 0; s < run.solids(); ++s) {
    add(run.solid(s).name + ": supports");
    for (const auto& term : run.solid(s).model->terms)
      if (term->isBody()) {
        add(run.solid(s).name + ": dissipated by " + term->name());
        if (term->ownsNodes()) add(run.solid(s).name + ": renewals of " + term->name());
      }
    if (!loads) continue;
    for (const char* const later : {"load steps", "work of loads in load steps", "dissipated in load steps"})
      add(run.solid(s).name + ": " + later);
  }
  if (std::ranges::any_of(built.walls, [](const WallParts& wall) { return wall.servo.has_value(); }) || changes)
    for (const char* const later : {"damping", "work of external forces (minus)"})
      add(std::string("particles: ") + later);
  add("kinetic damping");
  if (changes) add("changes (minus)");
  return names;
}

}  // namespace

struct SeriesRow::Impl {
  std::vector<std::string> channels;
  bool followsLoads;
  Probes probes;
  std::vector<std::string> names;
};

SeriesRow::SeriesRow(const Built& built, const Scene& scene)
    : impl_(std::make_unique<Impl>(
          Impl{channelsOf(built, hasStatics(scene),
                          std::ranges::any_of(scene.stages, [](const Stage& one) { return one.changes.has_value(); })),
               followsLoads(scene),
               Probes(built, scene),
               {}})) {
  impl_->names = columnsOf(impl_->channels, built, impl_->followsLoads, impl_->probes.names());
}
SeriesRow::~SeriesRow() = default;
SeriesRow::SeriesRow(SeriesRow&&) noexcept = default;
SeriesRow& SeriesRow::operator=(SeriesRow&&) noexcept = default;

const std::vector<std::string>& SeriesRow::names() const { return impl_->names; }
const std::vector<std::string>& SeriesRow::probeNames() const { return impl_->probes.names(); }

std::vector<std::pair<std::string, Vec3>> forcesOnSolids(const Built& built) {
  const auto contacts = std::as_const(built.run->grains).terms.all<surface::SurfaceContact>();
  std::vector<std::pair<std::string, Vec3>> forces;
  for (std::size_t s = 0; s < built.run->solids(); ++s) {
    const coupling::SolidSide& side = built.run->solid(s);
    Vec3 force;
    bool any = false;
    for (const auto* const contact : contacts) {
      if (&contact->side() != &side) continue;
      any = true;
      force += contact->onSolid({}).linear;
    }
    if (any) forces.emplace_back(side.name, force);
  }
  return forces;
}

std::vector<const dem::Insertion*> insertionsOf(const Built& built) {
  std::vector<const dem::Insertion*> all;
  for (const auto* const term : std::as_const(built.run->grains).terms.all<dem::InsertionTerm>())
    all.push_back(&term->insertion);
  return all;
}

std::vector<double> SeriesRow::probesNow(const Built& built) const {
  std::vector<double> row;
  impl_->probes.add(built, row);
  return row;
}

std::vector<double> SeriesRow::now(const Built& built, double limit) const {
  coupling::CoupledRun& run = *built.run;
  const coupling::Totals totals = run.totals();
  std::vector<double> row{run.time(), static_cast<double>(countOfGrains(run.grains.particles)), limit};
  // A ledger has its channels in the order in which they came to be, which is another one in a run that was resumed:
  // sums are made in an order of our own.
  std::map<std::string, EnergyLedger::Channel> channels;
  for (const auto& channel : run.ledger().channels()) channels[channel.name] = channel;
  double residual = 0.0, others = 0.0;
  for (const std::string& name : impl_->channels) {
    const EnergyLedger::Channel channel = channels[name];
    row.push_back(channel.joules);
    residual += channel.joules - channel.joulesAtOpening;
    channels.erase(name);
  }
  for (const auto& [name, channel] : channels) {
    others += channel.joules;
    residual += channel.joules - channel.joulesAtOpening;
  }
  row.insert(row.end(), {others, residual});
  const Vec3 given = totals.given.total().given.linear;
  for (const Vec3& v : {totals.momentum, given}) row.insert(row.end(), {v.x, v.y, v.z});
  for (const auto& [solid, force] : forcesOnSolids(built)) row.insert(row.end(), {force.x, force.y, force.z});
  appendCounts(built, row);
  for (std::size_t s = 0; impl_->followsLoads && s < run.solids(); ++s) row.push_back(run.loadFactor(s));
  impl_->probes.add(built, row);
  return row;
}

}  // namespace dovetail::scene
