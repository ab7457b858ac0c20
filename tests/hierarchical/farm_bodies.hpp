// Bodies of cells, to be run by fields in one process and by farms.
#pragma once

#include "cell_points.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "solids_of_cells.hpp"

namespace dovetail::hierarchical {

/// All points in this process, whatever farm there is.
template <class Settings>
std::shared_ptr<fem::PointField> fieldHere(std::vector<rve::Rve> samples, const Settings& settings) {
  const auto shared = std::make_shared<const std::vector<rve::Rve>>(std::move(samples));
  return fem::pointField({.name = "cells", .density = meanDensity(*shared)},
                         [make = cellMaker(shared, settings), n = shared->size()](const fem::PointPlace& place) {
                           return make(inTurn(place) % n);
                         });
}

/// What a run leaves: positions and states, to the last bit.
struct Outcomes {
  std::vector<Vec3> u;
  std::vector<double> P;
  std::vector<char> bytes;
  bool operator==(const Outcomes&) const = default;
};

inline Outcomes outcomesOf(Biaxial& body, const fem::PointField& field) {
  ByteWriter archive;
  field.save(archive);
  return {body.model.nodes.u, body.sample().P, archive.bytes()};
}

/// Load steps; points with too few cells between them to be alike.
inline Outcomes inLoadSteps(const std::shared_ptr<fem::PointField>& field) {
  Biaxial body({2, 2}, field);
  fem::solveStatics(body.model, 1.0, roughly());
  return outcomesOf(body, *field);
}

/// Explicit steps, with a state that is saved and loaded between them.
inline Outcomes inExplicitSteps(const std::shared_ptr<fem::PointField>& field, int before, int after) {
  Biaxial body({1, 2}, field, fem::ElementShape::quad4, 0.05);
  fem::addMass(body.model);
  fem::ExplicitIntegrator run(body.model, 2e-5);
  run.run(before);
  ByteWriter archive;
  run.save(archive);
  run.run(3);
  ByteReader back(archive.bytes());
  run.load(back);
  run.run(after);
  return outcomesOf(body, *field);
}

}  // namespace dovetail::hierarchical
