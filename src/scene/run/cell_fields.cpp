#include "cell_fields.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <functional>
#include <set>
#include <utility>

#include "build/parts.hpp"
#include "dovetail/core/archive.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/io/names.hpp"
#include "dovetail/rve/rve_archive.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

CellMeasures measured(const rve::Rve& cell) {
  const rve::Balance balance = rve::balance(cell);
  return {.voidRatio = 1.0 / rve::solidFraction(cell) - 1.0,
          .coordination = balance.coordination,
          .sliding = balance.contacts > 0 ? static_cast<double>(balance.sliding) / balance.contacts : 0.0,
          .fabric = rve::fabric(cell),
          .cauchy = rve::stress(cell).cauchy};
}

/// Calls look(k) of n cells: contacts of hundreds of grains each. On ranks one after another, as they are fetched.
template <class Look>
void inParts(std::size_t n, const Look& look) {
  const std::size_t chunk = hierarchical::ranksOfFarm() > 1 ? n : 4;
  parallelFor(n, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) look(k);
  });
}

}  // namespace

CellMeasures& CellMeasures::operator+=(const CellMeasures& other) {
  voidRatio += other.voidRatio, coordination += other.coordination, sliding += other.sliding;
  fabric += other.fabric, cauchy += other.cauchy;
  return *this;
}

CellMeasures CellMeasures::operator*(double factor) const {
  return {factor * voidRatio, factor * coordination, factor * sliding, factor * fabric, factor * cauchy};
}

double CellMeasures::pressure(int dimension) const {
  return -cauchy.topLeftCorner(dimension, dimension).trace() / dimension;
}

double CellMeasures::stressRatio(int dimension) const {
  const Eigen::MatrixXd part = -cauchy.topLeftCorner(dimension, dimension);
  const Eigen::VectorXd principal = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(part).eigenvalues();
  const double least = principal[0], most = principal[dimension - 1];
  return most + least > 0.0 ? (most - least) / (most + least) : 0.0;
}

std::vector<MeshField> cellsAt(const Points& points) {
  std::vector<MeshField> fields{{"void_ratio", {}, 1, false},
                                {"coordination", {}, 1, false},
                                {"sliding", {}, 1, false},
                                {"fabric", {}, 9, false}};
  for (MeshField& field : fields) field.values.resize(points.size() * static_cast<std::size_t>(field.components));
  std::vector<std::pair<const Points::Part*, std::size_t>> places;
  forEachPoint(points, [&](const Points::Part& part, std::size_t p) { places.emplace_back(&part, p); });
  std::atomic<bool> any = false;
  inParts(places.size(), [&](std::size_t at) {
    const auto [part, p] = places[at];
    if (!part->field) return;
    hierarchical::visitCell(*part->field, p, [&](const rve::Rve& cell) {
      const CellMeasures now = measured(cell);
      fields[0].values[at] = now.voidRatio;
      fields[1].values[at] = now.coordination;
      fields[2].values[at] = now.sliding;
      Eigen::Map<Eigen::Matrix3d>(&fields[3].values[9 * at]) = now.fabric;  // symmetric
      any = true;
    });
  });
  return any ? fields : std::vector<MeshField>{};
}

RepeatedCells repeatedCells(const fem::Model& model) {
  RepeatedCells cells;
  forEachPoint(pointsOf(model), [&](const Points::Part& part, std::size_t p) {
    const int copies = part.field ? hierarchical::copiesAt(*part.field, p) : 0;
    cells.all += copies > 0;
    cells.repeated += copies > 1;
    cells.mostCopies = std::max(cells.mostCopies, copies);
  });
  return cells;
}

std::vector<std::string> linesOnRepeatedCells(const coupling::CoupledRun& run) {
  std::vector<std::string> lines;
  for (std::size_t s = 0; s < run.solids(); ++s)
    if (const RepeatedCells cells = repeatedCells(*run.solid(s).model); cells.repeated > 0)
      lines.push_back("solid \"" + run.solid(s).name + "\": " + std::to_string(cells.repeated) + " of " +
                      std::to_string(cells.all) + " cells have become thin, and are repeated in up to " +
                      std::to_string(cells.mostCopies) + " copies");
  return lines;
}

std::vector<const hierarchical::FarmReport*> farmsOf(const fem::Model& model) {
  std::vector<const hierarchical::FarmReport*> farms;
  for (const Points::Part& part : pointsOf(model).parts)
    if (const auto* const farm = part.field ? hierarchical::farmReport(*part.field) : nullptr) farms.push_back(farm);
  return farms;
}

std::vector<std::string> linesOnFarms(const coupling::CoupledRun& run) {
  std::vector<std::string> lines;
  for (std::size_t s = 0; s < run.solids(); ++s)
    for (const hierarchical::FarmReport* const farm : farmsOf(*run.solid(s).model)) {
      std::string line = "solid \"" + run.solid(s).name + "\" on " + std::to_string(farm->points.size()) + " ranks:";
      for (std::size_t rank = 0; rank < farm->points.size(); ++rank)
        line += (rank > 0 ? ", " : " ") + std::to_string(farm->points[rank]) + " cells (" + rounded(farm->busy[rank]) +
                " s)";
      lines.push_back(line + "; " + std::to_string(farm->moves) + " moved, rank 0 waited " + rounded(farm->waited) +
                      " s");
    }
  return lines;
}

std::vector<CellPoint> cellPoints(const fem::Model& model) {
  std::vector<CellPoint> cells;
  int last = -1, point = -1;
  forEachPoint(pointsOf(model), [&](const Points::Part& part, std::size_t p) {
    const fem::Solid::Sample& sample = part.sample;
    point = sample.element[p] == last ? point + 1 : 0;  // of points without elements, their number
    last = sample.element[p];
    if (part.field && hierarchical::hasCell(*part.field, p))
      cells.push_back({part.field, p, last, point, sample.X[p], sample.volume[p]});
  });
  return cells;
}

std::vector<CellPoint> cellPointsOf(const std::string& solid, const Built& built) {
  std::vector<CellPoint> cells = cellPoints(*built.run->solid(solidNamed(solid, *built.run)).model);
  if (cells.empty())
    throw InputError("\"" + solid + "\" has no cells of grains", "", "name a solid of cells, or leave this out");
  return cells;
}

const CellPoint& nearestCell(const std::vector<CellPoint>& cells, const Vec3& at) {
  return *std::ranges::min_element(cells, {}, [&](const CellPoint& one) { return squaredNorm(one.X - at); });
}

std::vector<CellPoint> shownCells(const Built& built, const Output& output) {
  std::vector<CellPoint> places;
  std::set<std::string> names;
  for (const ShownCell& one : output.cells)
    atPlace(one.where, [&] {
      io::requirePlainName(one.name, "name");
      if (!names.insert(one.name).second || !names.insert(one.name + "_contacts").second)
        throw InputError("another cell has files of the name \"" + one.name + "\"", "name", "give it another name");
      places.push_back(nearestCell(cellPointsOf(one.solid, built), one.at));
    });
  return places;
}

void visit(const CellPoint& place, const std::function<void(const rve::Rve&)>& look) {
  hierarchical::visitCell(*place.field, place.number, look);
}

CellMeasures meanOf(const std::vector<CellPoint>& cells, int& dimension) {
  std::vector<CellMeasures> all(cells.size());
  inParts(cells.size(), [&](std::size_t k) {
    visit(cells[k], [&](const rve::Rve& cell) {
      all[k] = measured(cell);
      if (k == 0) dimension = cell.dimension();
    });
  });
  CellMeasures sum;
  double volume = 0.0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    sum += all[k] * cells[k].volume;
    volume += cells[k].volume;
  }
  return sum * (1.0 / volume);
}

namespace {

std::string lineOn(const std::string& name, const std::vector<rve::Rve>& cells) {
  const rve::Rve& first = cells.front();
  return "cells \"" + name + "\": " + std::to_string(cells.size()) + " of " + std::to_string(first.size()) +
         (first.shape == rve::Shape::disc ? " discs" : " spheres") + ", solid fraction " +
         rounded(rve::solidFraction(first)) + ", " + rounded(rve::balance(first).coordination) +
         " contacts per grain, pressure " + rounded(rve::stress(first).pressure) + " Pa";
}

std::size_t bytesOf(const rve::Rve& cell) {
  ByteWriter state;
  rve::writeState(cell, cell.state, state);
  return state.bytes().size();
}

}  // namespace

std::vector<std::string> linesOnCells(const Built& built) {
  std::vector<std::string> lines;
  for (const auto& [name, cells] : built.cells)
    if (!cells.empty()) lines.push_back(lineOn(name, cells));
  for (std::size_t s = 0; s < built.run->solids(); ++s) {
    const std::vector<CellPoint> cells = cellPoints(*built.run->solid(s).model);
    if (cells.empty()) continue;
    std::size_t grains = 0, each = 0;
    for (const CellPoint& one : cells) visit(one, [&](const rve::Rve& cell) { grains += cell.size(); });
    visit(cells.front(), [&](const rve::Rve& cell) { each = 2 * bytesOf(cell); });  // as committed, and as asked
    const double bytes = static_cast<double>(each * cells.size());
    lines.push_back("solid \"" + built.run->solid(s).name + "\": " + std::to_string(cells.size()) + " points with " +
                    std::to_string(grains) + " grains, " + rounded(bytes / 1048576.0) + " MiB");
  }
  return lines;
}

}  // namespace dovetail::scene
