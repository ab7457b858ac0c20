// Solids of material points of a scene.
#include <cmath>
#include <numbers>

#include "changes.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/dem/walls/rigid_wall.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/io/csv_table.hpp"
#include "dovetail/mpm/fill.hpp"
#include "dovetail/mpm/pair_gradient.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

mpm::GridBorder borderOf(const PointBorder& border) {
  return {.axis = border.side[0] - 'x',
          .above = border.side[1] == '+',
          .place = border.at,
          .kind = static_cast<mpm::BorderKind>(border.kind)};
}

mpm::PointOptions optionsOf(const PointGrid& grid) {
  mpm::PointOptions options{.grid = {.spacing = grid.spacing,
                                     .shape = static_cast<mpm::Shape>(grid.shape),
                                     .plane = grid.plane,
                                     .origin = grid.origin},
                            .transfer = static_cast<mpm::Transfer>(grid.transfer),
                            .damping = grid.damping,
                            .renewal = grid.renewal};
  if (grid.damping > 0.0 && options.transfer != mpm::Transfer::flip)
    throw InputError("damping is that of flip", "grid", "leave it out, or write \"transfer\": \"flip\"");
  for (const PointBorder& border : grid.borders)
    atPlace(border.where, [&] {
      options.grid.borders.push_back(borderOf(border));
      mpm::validate(options.grid);
    });
  return options;
}

void requireMemoryIn(const geometry::Box& box, const Solid& solid, const mpm::GridOptions& grid, int perAxis) {
  double count = 1.0;
  for (int c = 0; c < (grid.plane ? 2 : 3); ++c) count *= perAxis * (box.upper[c] - box.lower[c]) / grid.spacing;
  requireMemory(count, "points of \"" + solid.name + "\"", BytesPer::point, "take a wider spacing, or a smaller body");
}

// ---- what is filled

struct Filled {
  const Solid& solid;
  const mpm::GridOptions& grid;
  int perAxis;
  std::vector<std::string>& notes;

  mpm::MaterialPoints inside(const dem::PackingRoom& room, const std::function<bool(const Vec3&)>& isIn) const {
    requireMemoryIn(room.box, solid, grid, perAxis);
    return mpm::fillInside(grid, room.box, perAxis, isIn, room.volume, solid.velocity);
  }
  void requireSpace(const char* what, const char* remedy) const {
    if (grid.plane) throw InputError(std::string(what) + " is no body of plane strain", "points", remedy);
  }
};

mpm::MaterialPoints pointsIn(const Filled& to, const PointBox& from) {
  requireMemoryIn(from.box, to.solid, to.grid, to.perAxis);
  return mpm::fillBox(to.grid, from.box, to.perAxis, to.solid.velocity);
}

mpm::MaterialPoints pointsIn(const Filled& to, const CylinderRegion& from) {
  const dem::PackingRoom room = dem::cylinderRoom(from.point, from.axis, from.radius, from.length);
  if (!to.grid.plane)
    return to.inside(room, [&](const Vec3& x) {
      return std::ranges::all_of(room.walls, [&](const auto& wall) { return dem::distanceTo(wall, x).distance > 0.0; });
    });
  if (from.axis.x != 0.0 || from.axis.y != 0.0)
    throw InputError("the axis of the cylinder lies across that of plane strain", "points",
                     "give it the axis [0, 0, 1]");
  return to.inside(room,
                   [&](const Vec3& x) { return std::hypot(x.x - from.point.x, x.y - from.point.y) < from.radius; });
}

mpm::MaterialPoints pointsIn(const Filled& to, const PointBall& from) {
  to.requireSpace("a sphere", "take a cylinder along z");
  const Vec3 r{from.radius, from.radius, from.radius};
  dem::PackingRoom room{.box = {from.centre - r, from.centre + r}};
  room.volume = 4.0 / 3.0 * std::numbers::pi * from.radius * from.radius * from.radius;
  return to.inside(room, [&](const Vec3& x) { return norm(x - from.centre) < from.radius; });
}

mpm::MaterialPoints pointsIn(const Filled& to, const PointSurface& from) {
  to.requireSpace("a surface", "leave \"plane_strain\" out, or give the points in a file");
  const dem::PackingRoom room = dem::roomInside(surfaceOf(from.surface, geometry::ClosedPatches::turn, to.notes));
  return to.inside(
      room, [&](const Vec3& x) { return geometry::windingNumber(room.surface.x, room.surface.facets, x) > 0.5; });
}

mpm::MaterialPoints pointsIn(const Filled& to, const PointFile& from) {
  static const std::vector<std::string> velocity{"vx_m_per_s", "vy_m_per_s", "vz_m_per_s"};
  const io::CsvTable read = io::readCsvTable(from.file);
  const io::TimeSeries& table = read.series;
  const std::vector<std::string>& names = table.names();
  const auto has = [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
  const std::vector<std::string> places{"x_m", "y_m", "z_m"};
  for (const std::string& name : places)
    if (!has(name)) throw InputError("the table has no column \"" + name + "\"", from.file, "add it");
  for (const std::string& name : names)
    if (name != "volume_m3" && std::ranges::find(places, name) == places.end() &&
        std::ranges::find(velocity, name) == velocity.end())
      throw InputError("the table has a column \"" + name + "\", which is unknown", from.file,
                       "leave it out; points have x_m, y_m, z_m, volume_m3 and, all or none, vx_m_per_s, vy_m_per_s, "
                       "vz_m_per_s");
  const bool moves = std::ranges::any_of(velocity, has);
  if (moves && !std::ranges::all_of(velocity, has))
    throw InputError("the table has some components of a velocity", from.file, "give all three, 0 where there is none");
  if (to.grid.plane && !has("volume_m3"))
    throw InputError("the table has no column \"volume_m3\", and the thickness is not known", from.file, "add it");
  if (table.rows() == 0) throw InputError("the table has no rows", from.file, "give it points");
  mpm::MaterialPoints points;
  const auto vectorOf = [&](const std::vector<std::string>& of, std::size_t row) {
    return Vec3{table.column(of[0])[row], table.column(of[1])[row], table.column(of[2])[row]};
  };
  const double part = std::pow(to.grid.spacing / to.perAxis, 3);
  for (std::size_t k = 0; k < table.rows(); ++k) {
    points.x.push_back(vectorOf(places, k));
    points.v.push_back(to.solid.velocity + (moves ? vectorOf(velocity, k) : Vec3{}));
    points.volume.push_back(has("volume_m3") ? table.column("volume_m3")[k] : part);
  }
  return points;
}

void requireWithin(const mpm::MaterialPoints& points, const std::vector<PointBorder>& borders) {
  for (const PointBorder& border : borders) {
    const int axis = border.side[0] - 'x';
    const bool above = border.side[1] == '+';
    const auto beyond = std::ranges::count_if(
        points.x, [&](const Vec3& x) { return above ? x[axis] > border.at : x[axis] < border.at; });
    if (beyond > 0)
      throw InputError(std::to_string(beyond) + " of " + std::to_string(points.x.size()) +
                           " points lie beyond the border " + border.side,
                       border.where, "move the body, or the border");
  }
}

// ---- what has no meaning without elements

void requireNoElements(const Solid& solid, const Scene& scene) {
  struct Given {
    bool isGiven;
    const char *what, *remedy;
  };
  for (const Given& one :
       {Given{solid.formulation != "standard", "a formulation", "leave it out"},
        Given{solid.massFraction.has_value() && *solid.massFraction > 0.0, "a consistent mass", "leave it out"},
        Given{solid.state.has_value(), "a state", "resume the run in place of starting from it"},
        Given{!solid.regions.empty(), "regions", "give each material a solid, or take a mesh"},
        Given{!solid.supports.empty(), "supports", "give \"grid\" a border of the kind held or symmetry"},
        Given{std::ranges::any_of(solid.loads,
                                  [](const Load& load) { return std::holds_alternative<NodalLoad>(load.kind); }),
              "forces on nodes", "give a pressure or a traction on faces"},
        Given{!solid.ties.empty(), "ties", "leave them out"}})
    if (one.isGiven)
      throw InputError(std::string("material points have no elements, and ") + one.what + " no meaning", "",
                       one.remedy);
  for (const Stage& stage : scene.stages) {
    const auto* const statics = std::get_if<Statics>(&stage.kind);
    if (std::holds_alternative<FindModes>(stage.kind) || (statics && statics->arcLength))
      throw InputError(std::string(statics ? "paths of equilibria" : "modes") + " are those of meshes, and \"" +
                           solid.name + "\" is of material points",
                       stage.where, "leave the stage out");
    for (const SupportChange& change : stage.changes ? stage.changes->supports : std::vector<SupportChange>{})
      if (change.solid == solid.name)
        throw InputError("material points have no supports", change.where, "leave the change out");
  }
}

// ---- their faces

bool usesFaces(const Solid& solid, const Scene& scene) {
  return !solid.loads.empty() || !solid.planes.empty() ||
         std::ranges::any_of(scene.couplings, [&](const Coupling& one) {
           return one.solid == solid.name && std::holds_alternative<SurfaceContact>(one.kind);
         });
}

PointFaces& addFaces(Built& built, const Solid& solid, const mpm::GridOptions& grid, mpm::PointSolid& body) {
  const auto& filling = std::get<PointMesh>(solid.mesh).points;
  const auto* const box = std::get_if<PointBox>(&filling.from);
  if (!box)
    throw InputError("faces of material points are those of a box, and \"" + solid.name + "\" is none", solid.where,
                     "fill a \"box\", or take the coupling \"points\" in place of loads, planes and surfaces");
  PointFaces faces{mpm::facesOfBox(grid, box->box, filling.perAxis)};
  addSets(faces.mesh, solid);
  faces.set = body.addMarkers(faces.mesh.X);
  return built.faces.emplace(solid.name, std::move(faces)).first->second;
}

void addOnFaces(fem::Model& model, const std::shared_ptr<mpm::PointSolid>& body, const mpm::GridOptions& grid,
                const Solid& solid, const Scene& scene, Built& built) {
  if (!usesFaces(solid, scene)) return;
  const PointFaces& faces = addFaces(built, solid, grid, *body);
  const LoadedFaces loaded{
      faces.mesh, {}, [&](auto term) { model.add(mpm::onMarkers(body, faces.set, std::move(term))); }};
  addLoads(loaded, solid, scene, built);
  addPlanes(loaded, solid, scene, built);
}

// ---- what they are of

/// Corners of what points stand for: half an edge around them.
std::vector<Vec3> cornersOf(const mpm::MaterialPoints& points, double edge) {
  std::vector<Vec3> corners;
  for (const Vec3& x : points.x)
    for (const double side : {-0.5 * edge, 0.5 * edge}) corners.push_back(x + Vec3{side, side, side});
  return corners;
}

std::shared_ptr<fem::PointField> fieldIn(const Solid& solid, const mpm::MaterialPoints& points, const Scene& scene,
                                         const Built& built) {
  const auto* const cells = std::get_if<GrainCells>(&solid.material.law);
  if (!cells) return fem::pointField(makeMaterial(solid.material));
  const auto& [filling, grid] = std::get<PointMesh>(solid.mesh);
  requireDimension(*cells, grid.plane ? 2 : 3, fem::Formulation::standard, built);
  return fieldOf(*cells, built,
                 {.corners = cornersOf(points, grid.spacing / filling.perAxis),
                  .points = [&] { return points.x; },
                  .gravity = solid.gravity ? scene.gravity : Vec3{}});
}

}  // namespace

const fem::SolidMesh& facesOf(const Built& built, const Scene& scene, std::size_t solid) {
  const auto found = built.faces.find(scene.solids[solid].name);
  return found == built.faces.end() ? built.meshes[solid] : found->second.mesh;
}

bool isOfPoints(const Solid& solid) { return std::holds_alternative<PointMesh>(solid.mesh); }

std::unique_ptr<fem::Model> makePoints(const Solid& solid, const Scene& scene, Built& built) {
  requireNoElements(solid, scene);
  const auto& [filling, grid] = std::get<PointMesh>(solid.mesh);
  const mpm::PointOptions options = optionsOf(grid);
  const Filled to{solid, options.grid, filling.perAxis, built.notes};
  const mpm::MaterialPoints points = std::visit([&](const auto& from) { return pointsIn(to, from); }, filling.from);
  requireWithin(points, grid.borders);
  const auto body = mpm::makePoints(points, fieldIn(solid, points, scene, built), options);
  auto model = std::make_unique<fem::Model>(mpm::makeModel(body));
  if (solid.gravity && changesGravity(scene))
    model->add(mpm::gravity(body, [now = built.changing.gravity](double) { return *now; }));
  else if (solid.gravity && norm(scene.gravity) > 0.0)
    model->add(mpm::gravity(body, scene.gravity));
  if (solid.massDamping > 0.0) model->add(fem::massDamping(solid.massDamping));
  if (solid.gradient) model->add(mpm::pairGradient(body, points, {.modulus = solid.gradient->modulus}));
  addOnFaces(*model, body, options.grid, solid, scene, built);
  built.meshes.emplace_back().X = points.x;
  built.supports.emplace_back();
  return model;
}

std::size_t countOfGrains(const dem::Particles& particles) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) count += particles.isOfSolid(i) ? 0 : 1;
  return count;
}

const mpm::PointSolid* materialPoints(const fem::Model& model) {
  for (const auto& term : model.terms)
    if (const auto* const points = dynamic_cast<const mpm::PointSolid*>(term.get())) return points;
  return nullptr;
}

}  // namespace dovetail::scene
