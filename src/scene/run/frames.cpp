// Frames of grains, contacts, bonds, solids and walls in files of VTK.
#include "frames.hpp"

#include <algorithm>
#include <utility>

#include "build/parts.hpp"
#include "cell_fields.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/elements/material_point.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"
#include "dovetail/solid_io_vtk/solid_vtu.hpp"
#include "frame_fields.hpp"

namespace dovetail::scene {

struct Frames::Impl {
  std::vector<std::string> contents;
  std::vector<Solid> files;
  io::KeyValues provenance;
  std::vector<double> times;
  std::vector<io::VtuSeries> grains{}, contacts{}, bonds{};  // one, or none
  std::vector<io::VtuSeries> solids{}, walls{};
  std::vector<std::size_t> meshWalls{};  // of the model, in the order of walls
  struct PointSeries {
    io::VtuSeries series;
    std::vector<fem::MaterialPoint> place{};  // as soon as they are known
  };
  std::vector<PointSeries> points{};  // of all solids, or none
  struct CellSeries {
    CellPoint place;
    io::VtuSeries grains;
    std::vector<io::VtuSeries> contacts;  // one, or none
  };
  std::vector<CellSeries> cells{};

  bool has(const char* word) const { return std::find(contents.begin(), contents.end(), word) != contents.end(); }
  void addGrains(const dem::Particles& particles, double time);
  void addSolid(std::size_t s, const Built& built, double time);
  void addPoints(std::size_t s, const Built& built, double time);
  void addCell(CellSeries& to, double time);
  void dropLast();
};

namespace {

void addLines(io::VtuSeries& series, double time, const ForceLines& lines) {
  io::PolyFrame frame{.points = lines.ends,
                      .lines = lines.line,
                      .triangles = {},
                      .vectors = {{"force", lines.force}},
                      .scalars = {{"normal_force", lines.normal}, {"tangential_force", lines.tangential}},
                      .integers = {{"first", lines.first}, {"second", lines.second}}};
  if (!lines.utilised.empty()) frame.scalars.push_back({"utilised", lines.utilised});
  if (!lines.sliding.empty()) frame.scalars.push_back({"sliding", lines.sliding});
  series.write(time, frame);
}

void addWall(io::VtuSeries& series, double time, const dem::MeshWall& mesh) {
  const WallFacets facets = wallFacets(mesh);
  series.write(time, io::PolyFrame{.points = mesh.wall.x,
                                   .lines = {},
                                   .triangles = mesh.wall.facets,
                                   .vectors = {{"traction", facets.traction}},
                                   .scalars = {{"pressure", facets.pressure}},
                                   .integers = {}});
}

}  // namespace

void requireFrames(const Output& output) {
  const auto has = [&](const char* word) {
    return std::find(output.contents.begin(), output.contents.end(), word) != output.contents.end();
  };
  for (const auto& [word, bearer] : {std::pair{"spin", "grains"},
                                     {"forces", "grains"},
                                     {"stress", "solids"},
                                     {"strain", "solids"},
                                     {"cells", "solids"},
                                     {"history", "solids"}})
    if (has(word) && !has(bearer) && !(bearer == std::string("solids") && has("points")) &&
        !(word == std::string("spin") && !output.cells.empty()))
      throw InputError(std::string("contents has \"") + word + "\", but no \"" + bearer + "\"", output.where,
                       std::string("add \"") + bearer + "\"" +
                           (bearer == std::string("solids") ? " or \"points\"" : "") + ", or leave it out");
}

void Frames::Impl::addGrains(const dem::Particles& particles, double time) {
  io::ParticleFrame frame = io::frameOf(particles);
  if (!has("forces")) frame.force = {};
  if (has("spin") && particles.rotates()) frame.vectors.push_back({"spin", particles.omega});
  if (has("weights") && !particles.weight.empty()) frame.scalars.push_back({"weight", particles.weight});
  grains[0].write(time, frame);
}

void Frames::Impl::addSolid(std::size_t s, const Built& built, double time) {
  const fem::Model& model = *built.run->solid(s).model;
  const fem::SolidMesh& mesh = built.meshes[s];
  const std::vector<MeshField> values = solidFields(model, mesh.elementCount(), files[s], contents);
  if (isOfPoints(files[s])) {
    io::PointFrame frame{.points = mesh.X, .fields = {}, .integers = {}};
    for (const MeshField& field : values) frame.fields.push_back({field.name, field.values, field.components});
    return solids[s].write(time, frame);
  }
  solid_io::VtuFields fields{.time = time};
  for (const MeshField& field : values)
    (field.perCell ? fields.perCell : fields.perPoint).push_back({field.name, field.values, field.components});
  solids[s].write(time, solid_io::vtuText(mesh, fields, io::withMark(provenance)));
}

void Frames::Impl::addPoints(std::size_t s, const Built& built, double time) {
  const fem::Model& model = *built.run->solid(s).model;
  const Points now = pointsOf(model);
  PointSeries& to = points[s];
  std::vector<Vec3> X;
  std::vector<std::int64_t> element;
  forEachPoint(now, [&](const Points::Part& part, std::size_t p) {
    X.push_back(part.sample.X[p]);
    element.push_back(part.sample.element[p]);
  });
  std::vector<Vec3> u;
  if (const auto* const body = materialPoints(model))
    u = displacementsOf(*body, model.nodes);
  else if (to.place.empty()) {
    const fem::ElementLocator locator(built.meshes[s]);
    for (const Vec3& at : X) to.place.emplace_back(built.meshes[s], locator, at);
  }
  for (const fem::MaterialPoint& place : to.place) u.push_back(place.valueOf(model.nodes.u));
  const std::vector<MeshField> values = pointFields(now, files[s], contents);
  io::PointFrame frame{
      .points = X, .fields = {{"displacement", {&u[0].x, 3 * u.size()}, 3}}, .integers = {{"element", element}}};
  for (const MeshField& field : values) frame.fields.push_back({field.name, field.values, field.components});
  to.series.write(time, frame);
}

void Frames::Impl::addCell(CellSeries& to, double time) {
  visit(to.place, [&](const rve::Rve& cell) {
    const CellGrains own = grainsOf(cell);
    io::ParticleFrame frame{.position = own.x,
                            .radius = cell.radius,
                            .velocity = own.v,
                            .force = {},
                            .id = {},
                            .vectors = {},
                            .scalars = {}};
    if (has("spin")) frame.vectors.push_back({"spin", own.spin});
    to.grains.write(time, frame);
    if (!to.contacts.empty()) addLines(to.contacts[0], time, own.contacts);
  });
}

void Frames::Impl::dropLast() {
  for (std::vector<io::VtuSeries>* const all : {&grains, &contacts, &bonds, &solids, &walls})
    for (io::VtuSeries& one : *all) one.dropLast();
  for (PointSeries& one : points) one.series.dropLast();
  for (CellSeries& one : cells) {
    one.grains.dropLast();
    for (io::VtuSeries& lines : one.contacts) lines.dropLast();
  }
  times.pop_back();
}

Frames::Frames(const Built& built, const Scene& scene, const std::filesystem::path& folder,
               const io::KeyValues& provenance, const std::vector<double>& times)
    : impl_(std::make_unique<Impl>(Impl{scene.output.contents, {}, provenance, times})) {
  requireFrames(scene.output);
  impl_->files = scene.solids;
  const auto add = [&](std::vector<io::VtuSeries>& to, const std::string& name, io::FrameFile file) {
    to.emplace_back(folder, name, provenance, times, file);
  };
  if (impl_->has("grains")) add(impl_->grains, "grains", io::FrameFile::vtu);
  const bool anyGrains = built.run->grains.particles.size() > 0 || !scene.insertions.empty();
  if (anyGrains && impl_->has("contacts")) add(impl_->contacts, "contacts", io::FrameFile::vtp);
  if (impl_->has("bonds") && !built.run->grains.terms.all<dem::BondTerm>().empty())
    add(impl_->bonds, "bonds", io::FrameFile::vtp);
  if (impl_->has("solids"))
    for (std::size_t s = 0; s < built.meshes.size(); ++s)
      add(impl_->solids, "solid_" + built.run->solid(s).name, io::FrameFile::vtu);
  if (impl_->has("points"))
    for (std::size_t s = 0; s < built.meshes.size(); ++s)
      impl_->points.push_back({{folder, "points_" + built.run->solid(s).name, provenance, times}});
  const std::vector<CellPoint> shown = shownCells(built, scene.output);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const std::string name = "cell_" + scene.output.cells[k].name;
    Impl::CellSeries& to = impl_->cells.emplace_back(Impl::CellSeries{shown[k], {folder, name, provenance, times}, {}});
    if (impl_->has("contacts")) add(to.contacts, name + "_contacts", io::FrameFile::vtp);
  }
  if (!impl_->has("walls")) return;
  for (std::size_t w = 0; w < built.walls.size(); ++w)
    if (built.walls[w].firstMesh < built.walls[w].endMesh) {
      add(impl_->walls, "wall_" + std::to_string(w), io::FrameFile::vtp);
      impl_->meshWalls.push_back(built.walls[w].firstMesh);
    }
}
Frames::~Frames() = default;

std::vector<double> Frames::times() const { return impl_->times; }

void Frames::add(const Built& built, SameInstant before) {
  const bool again = !impl_->times.empty() && impl_->times.back() == built.run->time();
  if (again && before == SameInstant::replaced) impl_->dropLast();
  const double last = impl_->times.empty() ? -1.0 : impl_->times.back();
  const double time = built.run->time() > last ? built.run->time() : last + 1e-12 * std::max(1.0, last);
  const dem::Model& grains = built.run->grains;
  if (!impl_->grains.empty()) impl_->addGrains(grainsAlone(grains.particles), time);
  if (!impl_->contacts.empty()) addLines(impl_->contacts[0], time, contactLines(grains));
  if (!impl_->bonds.empty()) addLines(impl_->bonds[0], time, bondLines(grains));
  for (std::size_t s = 0; s < impl_->solids.size(); ++s) impl_->addSolid(s, built, time);
  for (std::size_t s = 0; s < impl_->points.size(); ++s) impl_->addPoints(s, built, time);
  for (Impl::CellSeries& cell : impl_->cells) impl_->addCell(cell, time);
  static const dem::MeshWall nothing{};  // in place of a wall that is away
  const auto meshes = grains.terms.all<dem::MeshWallTerm>();
  for (std::size_t w = 0; w < impl_->walls.size(); ++w) {
    const dem::MeshWallTerm& term = *meshes[impl_->meshWalls[w]];
    addWall(impl_->walls[w], time, term.present ? term.mesh : nothing);
  }
  impl_->times.push_back(time);
}

void writeModes(const std::filesystem::path& folder, const Built& built, std::size_t solid, const fem::Modes& modes,
                const io::KeyValues& provenance) {
  const coupling::SolidSide& side = std::as_const(*built.run).solid(solid);
  const fem::SolidMesh& mesh = built.meshes[solid];
  Vec3 lower = mesh.X.front(), upper = lower;
  for (const Vec3& X : mesh.X)
    for (int c = 0; c < 3; ++c) lower[c] = std::min(lower[c], X[c]), upper[c] = std::max(upper[c], X[c]);
  const double size = 0.1 * norm(upper - lower);
  const auto flat = [](const std::vector<Vec3>& vectors) {
    return std::vector<double>(&vectors[0].x, &vectors[0].x + 3 * vectors.size());
  };
  io::VtuSeries series(folder, "modes_" + side.name, provenance, {}, io::FrameFile::vtu);
  for (std::size_t m = 0; m < modes.shape.size(); ++m) {
    std::vector<Vec3> u = side.nodes().u;
    for (std::size_t n = 0; n < u.size(); ++n) u[n] += size * modes.shape[m][n];
    const double number = static_cast<double>(m + 1);
    const std::vector<double> moved = flat(u), shape = flat(modes.shape[m]);
    solid_io::VtuFields fields{.time = number};
    fields.perPoint.push_back({"displacement", moved, 3});
    fields.perPoint.push_back({"shape", shape, 3});
    series.write(number, solid_io::vtuText(mesh, fields, io::withMark(provenance)));
  }
}

}  // namespace dovetail::scene
