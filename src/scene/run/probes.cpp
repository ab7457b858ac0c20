#include "probes.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "build/changes.hpp"
#include "build/extent.hpp"
#include "build/parts.hpp"
#include "build/wall_motion.hpp"
#include "cell_fields.hpp"
#include "dovetail/arlequin/cells.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/mesh/element_locator.hpp"
#include "dovetail/io/names.hpp"
#include "dovetail/mpm/point_solid.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "frame_fields.hpp"

namespace dovetail::scene {

namespace {

void append(std::vector<double>& row, const Vec3& v) { row.insert(row.end(), {v.x, v.y, v.z}); }

/// Number of the place that is nearest. @param places  at least one
std::size_t nearestTo(const Vec3& at, const std::vector<Vec3>& places) {
  const auto nearer = [&](const Vec3& a, const Vec3& b) { return squaredNorm(a - at) < squaredNorm(b - at); };
  return static_cast<std::size_t>(std::min_element(places.begin(), places.end(), nearer) - places.begin());
}

/// Who acts on some nodes: supports, or where there are none, ties.
struct HeldBy {
  bool supports = false, ties = false;
};
HeldBy holdersOf(const coupling::SolidSide& side, const std::vector<int>& set) {
  HeldBy found;
  for (const int node : set)
    for (std::size_t c = 0; c < 3; ++c) {
      const fem::Role role = side.mass->dofs().role(3 * static_cast<std::size_t>(node) + c);
      found.ties = found.ties || role == fem::Role::tied;
      found.supports = found.supports || (role != fem::Role::tied && role != fem::Role::free);
    }
  return found;
}

/// Force on a wall, N, and its moment about a point, N m.
Momenta forceOn(const dem::Model& grains, const WallParts& parts, const Vec3& about) {
  Momenta sum;
  for (std::size_t i = parts.firstPrimitive; i < parts.endPrimitive; ++i) {
    const dem::PrimitiveWall& wall = dem::primitiveWall(grains, i);
    sum.linear += wall.force;
    sum.angular += wall.torque + cross(wall.point - about, wall.force);
  }
  for (std::size_t i = parts.firstMesh; i < parts.endMesh; ++i) {
    sum.linear += dem::totalForce(dem::meshWall(grains, i).wall);
    sum.angular += dem::totalMoment(dem::meshWall(grains, i).wall, about);
  }
  return sum;
}

void appendRegion(const dem::Particles& particles, const geometry::Box& box, std::vector<double>& row) {
  double count = 0.0, mass = 0.0;
  Vec3 momentum;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3& x = particles.x[i];
    bool inside = true;
    for (int c = 0; c < 3; ++c) inside = inside && x[c] >= box.lower[c] && x[c] <= box.upper[c];
    if (!inside || particles.isOfSolid(i)) continue;
    const double m = particles.mass[i] * particles.weightOf(i);
    count += 1.0;
    mass += m;
    momentum += m * particles.v[i];
  }
  row.push_back(count);
  append(row, mass > 0.0 ? 1.0 / mass * momentum : Vec3{});
}

/// Of a mean over a part of a solid: nodes, or material points, and their weights.
using Mean = std::vector<std::pair<std::size_t, double>>;

bool holds(const geometry::Box& box, const Vec3& x) {
  for (int k = 0; k < 3; ++k)
    if (x[k] < box.lower[k] || x[k] > box.upper[k]) return false;
  return true;
}

/// By volume, as the solid is now: points as fine as a sixteenth of the region stand for it.
Mean meanOver(const geometry::Box& box, const fem::SolidMesh& mesh, const fem::Nodes& nodes) {
  constexpr int fineness = 16;
  std::vector<Vec3> position = nodes.X;
  for (std::size_t n = 0; n < position.size(); ++n) position[n] += nodes.u[n];
  Extent extent;
  extent.add(position);
  Vec3 lower, step;
  for (int k = 0; k < 3; ++k) {
    lower[k] = std::max(box.lower[k], extent.lower[k]);
    step[k] = (std::min(box.upper[k], extent.upper[k]) - lower[k]) / fineness;
    if (step[k] < 0.0 || (step[k] == 0.0 && extent.upper[k] > extent.lower[k])) return {};
  }
  const fem::ElementLocator locator(mesh.groups, position);
  std::vector<double> weight(position.size(), 0.0);
  double points = 0.0;
  for (int z = 0; z < fineness; ++z)
    for (int y = 0; y < fineness; ++y)
      for (int x = 0; x < fineness; ++x) {
        const auto place = locator.find(lower + Vec3{(x + 0.5) * step.x, (y + 0.5) * step.y, (z + 0.5) * step.z});
        if (!place) continue;
        const std::span<const int> node = arlequin::cellOf(mesh, place->element).node;
        for (std::size_t a = 0; a < place->shape.size(); ++a)
          weight[static_cast<std::size_t>(node[a])] += place->shape[a];
        points += 1.0;
      }
  Mean mean;
  for (std::size_t n = 0; n < weight.size(); ++n)
    if (weight[n] != 0.0) mean.emplace_back(n, weight[n] / points);
  return mean;
}

/// By mass.
Mean meanOver(const geometry::Box& box, const mpm::PointSolid& body, const fem::Nodes& nodes) {
  const std::vector<Vec3> places = body.places(nodes);
  Mean mean;
  double mass = 0.0;
  for (std::size_t p = 0; p < places.size(); ++p)
    if (holds(box, places[p])) {
      mean.emplace_back(p, body.masses()[p]);
      mass += body.masses()[p];
    }
  for (auto& [number, weight] : mean) weight /= mass;
  return mean;
}

}  // namespace

void Probes::nameVector(const std::string& name, const std::string& unit) {
  for (const char* const axis : {"x", "y", "z"}) names_.push_back(name + axis + "_" + unit);
}

template <>
Probes::Values Probes::find(const Built& built, const Scene&, const std::string& name, const GrainProbe& kind) {
  const dem::Particles particles = grainsAlone(built.run->grains.particles);
  if (particles.size() == 0) throw InputError("there are no grains at the start", "", "leave the probe out");
  const std::int64_t id = particles.id[nearestTo(kind.at, particles.x)];
  nameVector(name + "_", "m");
  nameVector(name + "_v", "m_per_s");
  return [id](const Built& now, std::vector<double>& row) {
    const dem::Particles& all = now.run->grains.particles;
    const int number = dem::find(all, id);
    constexpr double gone = std::numeric_limits<double>::quiet_NaN();
    if (number < 0) return void(row.insert(row.end(), 6, gone));
    append(row, all.x[static_cast<std::size_t>(number)]);
    append(row, all.v[static_cast<std::size_t>(number)]);
  };
}

template <>
Probes::Values Probes::find(const Built& built, const Scene&, const std::string& name, const NodeProbe& kind) {
  const std::size_t solid = solidNamed(kind.solid, *built.run);
  const std::size_t node = nearestTo(kind.at, built.meshes[solid].X);
  nameVector(name + "_u", "m");
  if (materialPoints(*built.run->solid(solid).model))
    return [solid, node, X = built.meshes[solid].X[node]](const Built& now, std::vector<double>& row) {
      const fem::Model& model = *std::as_const(*now.run).solid(solid).model;
      append(row, materialPoints(model)->places(model.nodes)[node] - X);
    };
  return [solid, node](const Built& now, std::vector<double>& row) {
    append(row, std::as_const(*now.run).solid(solid).nodes().u[node]);
  };
}

template <>
Probes::Values Probes::find(const Built& built, const Scene&, const std::string& name, const BodyProbe& kind) {
  const std::size_t solid = solidNamed(kind.solid, *built.run);
  nameVector(name + "_", "m");
  nameVector(name + "_v", "m_per_s");
  nameVector(name + "_least_", "m");
  nameVector(name + "_most_", "m");
  return [solid](const Built& now, std::vector<double>& row) {
    const fem::Model& model = *std::as_const(*now.run).solid(solid).model;
    const auto* const body = materialPoints(model);
    std::vector<Vec3> x = body ? body->places(model.nodes) : model.nodes.X;
    for (std::size_t n = 0; !body && n < x.size(); ++n) x[n] += model.nodes.u[n];
    const std::vector<Vec3> v = body ? velocitiesOf(*body, model.nodes) : model.nodes.v;
    const std::vector<double>& ofNodes = model.nodes.bodyMass.empty() ? model.nodes.mass : model.nodes.bodyMass;
    const std::vector<double>& mass = body ? body->masses() : ofNodes;
    Vec3 centre, momentum;
    double all = 0.0;
    Extent extent;
    extent.add(x);
    for (std::size_t n = 0; n < x.size(); ++n) all += mass[n], centre += mass[n] * x[n], momentum += mass[n] * v[n];
    for (const Vec3& one : {1.0 / all * centre, 1.0 / all * momentum, extent.lower, extent.upper}) append(row, one);
  };
}

template <>
Probes::Values Probes::find(const Built& built, const Scene& scene, const std::string& name, const WallProbe& kind) {
  const std::size_t item = wallNamed(kind.wall, scene);
  nameVector(name + "_", "N");
  nameVector(name + "_m", "Nm");
  nameVector(name + "_u", "m");
  const Vec3 start = built.walls[item].point + built.walls[item].centre;
  return [item, start](const Built& now, std::vector<double>& row) {
    const WallParts& wall = now.walls[item];
    const Vec3 centre = centreOf(wall, now.run->grains);
    const Momenta force = forceOn(now.run->grains, wall, centre);
    append(row, force.linear);
    append(row, force.angular);
    append(row, centre - start);
  };
}

template <>
Probes::Values Probes::find(const Built& built, const Scene& scene, const std::string& name, const SolidProbe& kind) {
  solidNamed(kind.solid, *built.run);
  std::vector<std::size_t> contacts;
  std::size_t next = 0;
  for (const Coupling& coupling : scene.couplings) {
    const auto* const surface = std::get_if<SurfaceContact>(&coupling.kind);
    if (!surface) continue;
    if (coupling.solid == kind.solid && (kind.on.empty() || kind.on == surface->on)) contacts.push_back(next);
    ++next;
  }
  if (contacts.empty())
    throw InputError(
        "\"" + kind.solid + "\" has no surface coupling" + (kind.on.empty() ? "" : " on \"" + kind.on + "\""), "",
        "give it one, or leave the probe out");
  nameVector(name + "_", "N");
  nameVector(name + "_m", "Nm");
  return [contacts, about = kind.point.value_or(Vec3{})](const Built& now, std::vector<double>& row) {
    const auto all = std::as_const(now.run->grains).terms.all<surface::SurfaceContact>();
    Momenta force;
    for (const std::size_t k : contacts) force += all[k]->onSolid(about);
    append(row, force.linear);
    append(row, force.angular);
  };
}

template <>
Probes::Values Probes::find(const Built& built, const Scene&, const std::string& name, const DriveProbe& kind) {
  const auto item = static_cast<std::size_t>(kind.drive);
  if (const auto there = std::as_const(built.run->grains).terms.all<dem::DriveTerm>().size(); item >= there)
    throw InputError("there is no drive " + std::to_string(kind.drive), "",
                     "the scene has " + std::to_string(there) + ", counted from 0");
  nameVector(name + "_", "N");
  nameVector(name + "_m", "Nm");
  return [item](const Built& now, std::vector<double>& row) {
    const Momenta& support = std::as_const(now.run->grains).terms.all<dem::DriveTerm>()[item]->support;
    append(row, support.linear);
    append(row, support.angular);
  };
}

template <>
Probes::Values Probes::find(const Built& built, const Scene&, const std::string& name, const PlaneProbe& kind) {
  const std::size_t solid = solidNamed(kind.solid, *built.run);
  const auto plane = static_cast<std::size_t>(kind.plane);
  if (const auto there = planeReports(*built.run->solid(solid).model).size(); plane >= there)
    throw InputError("\"" + kind.solid + "\" has no plane " + std::to_string(kind.plane), "",
                     "it has " + std::to_string(there) + ", counted from 0");
  nameVector(name + "_", "N");
  names_.push_back(name + "_deepest_m");
  return [solid, plane](const Built& now, std::vector<double>& row) {
    const auto report = planeReports(*std::as_const(*now.run).solid(solid).model)[plane];
    append(row, report.force);
    row.push_back(report.deepest);
  };
}

template <>
Probes::Values Probes::find(const Built& built, const Scene& scene, const std::string& name, const SupportProbe& kind) {
  const std::size_t solid = solidNamed(kind.solid, *built.run);
  const std::vector<int>& set = fem::nodeSet(built.meshes[solid], kind.on);
  HeldBy by = holdersOf(built.run->solid(solid), set);
  if (changesSupports(scene.solids[solid], scene) && !by.ties) by.supports = true;
  if (!by.supports && !by.ties)
    throw InputError("neither supports nor ties act on the nodes \"" + kind.on + "\" of \"" + kind.solid + "\"", "",
                     "give the solid a support there, or leave the probe out");
  nameVector(name + "_", "N");
  nameVector(name + "_m", "Nm");
  return [solid, set, supports = by.supports, known = reactions_](const Built& now, std::vector<double>& row) {
    if (!known->contains(solid)) known->emplace(solid, now.run->reactions(solid));
    const coupling::Reactions& all = known->at(solid);
    const fem::Nodes& nodes = std::as_const(*now.run).solid(solid).nodes();
    Vec3 sum, moment, centre;
    const auto placeOf = [&](std::size_t n) { return nodes.X[n] + nodes.u[n]; };
    for (const int node : set)
      centre += 1.0 / static_cast<double>(set.size()) * placeOf(static_cast<std::size_t>(node));
    for (const int node : set) {
      const auto n = static_cast<std::size_t>(node);
      const Vec3& force = (supports ? all.supports : all.ties)[n];
      sum += force;
      moment += cross(placeOf(n) - centre, force);
    }
    append(row, sum);
    append(row, moment);
  };
}

template <>
Probes::Values Probes::find(const Built& built, const Scene&, const std::string& name, const RegionProbe& kind) {
  if (kind.solid.empty()) names_.push_back(name + "_particles");
  nameVector(name + "_v", "m_per_s");
  if (!kind.solid.empty()) {
    const std::size_t solid = solidNamed(kind.solid, *built.run);
    const fem::Model& model = *std::as_const(*built.run).solid(solid).model;
    const auto* const body = materialPoints(model);
    const Mean mean =
        body ? meanOver(kind.box, *body, model.nodes) : meanOver(kind.box, built.meshes[solid], model.nodes);
    if (mean.empty())
      throw InputError("nothing of \"" + kind.solid + "\" is in the region at the start", "", "move the box onto it");
    return [solid, mean](const Built& now, std::vector<double>& row) {
      const fem::Model& is = *std::as_const(*now.run).solid(solid).model;
      const auto* const points = materialPoints(is);
      const std::vector<Vec3> ofPoints = points ? velocitiesOf(*points, is.nodes) : std::vector<Vec3>{};
      const std::vector<Vec3>& v = points ? ofPoints : is.nodes.v;
      Vec3 sum;
      for (const auto& [number, weight] : mean) sum += weight * v[number];
      append(row, sum);
    };
  }
  return [box = kind.box](const Built& now, std::vector<double>& row) {
    appendRegion(now.run->grains.particles, box, row);
  };
}

template <>
Probes::Values Probes::find(const Built& built, const Scene&, const std::string& name, const CellsProbe& kind) {
  std::vector<CellPoint> cells = cellPointsOf(kind.solid, built);
  if (kind.at) cells = {nearestCell(cells, *kind.at)};
  for (const char* const what : {"pressure_Pa", "stress_ratio", "void_ratio", "coordination", "sliding"})
    names_.push_back(name + "_" + what);
  return [cells](const Built&, std::vector<double>& row) {
    int dimension = 3;
    const CellMeasures mean = meanOf(cells, dimension);
    row.insert(row.end(), {mean.pressure(dimension), mean.stressRatio(dimension), mean.voidRatio, mean.coordination,
                           mean.sliding});
  };
}

Probes::Probes(const Built& built, const Scene& scene) {
  for (const Probe& probe : scene.output.probes)
    atPlace(probe.where, [&] {
      io::requirePlainName(probe.name, "name");
      std::visit([&](const auto& kind) { values_.push_back(find(built, scene, probe.name, kind)); }, probe.of);
    });
}

void Probes::add(const Built& built, std::vector<double>& row) const {
  reactions_->clear();
  for (const Values& values : values_) values(built, row);
}

}  // namespace dovetail::scene
