#include "point_fields.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>

#include "build/parts.hpp"
#include "dovetail/fem/laws/field_history.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "dovetail/mpm/point_solid.hpp"

namespace dovetail::scene {

namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Eigen::Map<const RowMajor> deformationOf(const Points::Part& part, std::size_t p) {
  return Eigen::Map<const RowMajor>(&part.sample.F[9 * p]);
}

/// Room for all points.
MeshField fieldAt(const Points& points, const char* name, int components = 1) {
  return {name, std::vector<double>(points.size() * static_cast<std::size_t>(components)), components, false};
}
Eigen::Map<RowMajor> matrixAt(MeshField& field, std::size_t number) {
  return Eigen::Map<RowMajor>(&field.values[9 * number]);
}

void remember(MeshField& to, std::size_t number, std::span<const double> values) {
  std::copy(values.begin(), values.end(), &to.values[number * static_cast<std::size_t>(to.components)]);
}

}  // namespace

namespace {

/// Without asking the law again: that would be from another state than the next step's.
fem::Solid::Sample sampleOf(const fem::FieldAnswers& answers) {
  const auto copy = [](std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); };
  fem::Solid::Sample sample;
  for (const fem::PointPlace& place : answers.places()) {
    sample.element.push_back(place.element);
    sample.X.push_back(place.X);
    sample.volume.push_back(place.volume);
  }
  sample.F = copy(answers.F());
  sample.P = copy(answers.P());
  sample.energy = copy(answers.energy());
  sample.history = copy(fem::historyOf(answers.field()));
  return sample;
}

}  // namespace

Points pointsOf(const fem::Model& model) {
  Points points;
  for (const auto& term : model.terms)
    if (auto* const solid = dynamic_cast<fem::Solid*>(term.get()))
      points.parts.push_back({solid->name(), solid->field(), solid->sample(model.nodes, {.t = model.t})});
    else if (const auto* const body = dynamic_cast<const mpm::PointSolid*>(term.get()))
      points.parts.push_back({body->name(), &body->answers().field(), sampleOf(body->answers())});
  return points;
}

std::vector<Vec3> displacementsOf(const mpm::PointSolid& body, const fem::Nodes& nodes) {
  std::vector<Vec3> u = body.places(nodes);
  for (std::size_t p = 0; p < u.size(); ++p) u[p] -= body.answers().places()[p].X;
  return u;
}

std::vector<Vec3> velocitiesOf(const mpm::PointSolid& body, const fem::Nodes& nodes) {
  std::vector<Vec3> v;
  for (std::size_t p = 0; p < body.masses().size(); ++p) v.push_back(mpm::valueAt(body.rows(), p, nodes.v));
  return v;
}

std::vector<double> radiiOf(const mpm::PointSolid& body, const PointMesh& mesh) {
  std::vector<double> radius;
  const double edge = mesh.grid.spacing / mesh.points.perAxis;
  for (const fem::PointPlace& place : body.answers().places()) {
    const Eigen::Map<const RowMajor> F(&body.answers().F()[9 * radius.size()]);
    const double J = F.determinant();
    radius.push_back(0.5 * (mesh.grid.plane ? edge * std::sqrt(J) : std::cbrt(J * place.volume)));
  }
  return radius;
}

MeshField stressAt(const Points& points) {
  MeshField stress = fieldAt(points, "stress", 9);
  std::size_t next = 0;
  forEachPoint(points, [&](const Points::Part& part, std::size_t p) {
    const Eigen::Map<const RowMajor> F = deformationOf(part, p), P(&part.sample.P[9 * p]);
    matrixAt(stress, next++) = P * F.transpose() / F.determinant();
  });
  return stress;
}

std::vector<MeshField> invariantsOf(const MeshField& stress) {
  MeshField vonMises{"von_mises", {}, 1, stress.perCell}, pressure{"pressure", {}, 1, stress.perCell};
  for (std::size_t k = 0; k + 9 <= stress.values.size(); k += 9) {
    const Eigen::Map<const RowMajor> s(&stress.values[k]);
    const double p = -s.trace() / 3.0;
    pressure.values.push_back(p);
    vonMises.values.push_back(std::sqrt(1.5) * (s + p * RowMajor::Identity()).norm());
  }
  return {std::move(vonMises), std::move(pressure)};
}

std::vector<MeshField> strainsAt(const Points& points) {
  MeshField strain = fieldAt(points, "strain", 9), volume = fieldAt(points, "volume_strain"),
            shear = fieldAt(points, "shear_strain"), turn = fieldAt(points, "turn", 3);
  std::size_t next = 0;
  forEachPoint(points, [&](const Points::Part& part, std::size_t p) {
    const RowMajor F = deformationOf(part, p);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> b(F * F.transpose());
    const Eigen::Vector3d stretch = b.eigenvalues().cwiseSqrt();
    const Eigen::Matrix3d n = b.eigenvectors();
    const RowMajor e = n * stretch.array().log().matrix().asDiagonal() * n.transpose();
    const Eigen::Matrix3d R = n * stretch.cwiseInverse().asDiagonal() * n.transpose() * F;
    const Eigen::AngleAxisd angle(R);
    matrixAt(strain, next) = e;
    volume.values[next] = e.trace();
    shear.values[next] = std::sqrt(2.0) * (e - e.trace() / 3.0 * RowMajor::Identity()).norm();
    Eigen::Map<Eigen::Vector3d>(&turn.values[3 * next]) = angle.angle() * angle.axis();
    ++next;
  });
  return {std::move(strain), std::move(volume), std::move(shear), std::move(turn)};
}

std::vector<MeshField> historyAt(const Points& points, const Solid& solid) {
  struct Memory {
    bool flows;
    std::span<const double> values;
  };
  std::vector<Memory> all;
  std::size_t size = 0;
  bool flows = false;
  forEachPoint(points, [&](const Points::Part& part, std::size_t p) {
    const SolidMaterial& material = materialOf(solid, part.name);
    const std::size_t own = part.sample.history.size() / part.sample.element.size();
    const std::span<const double> values(part.sample.history.data() + own * p, own);
    const bool yielding = own > 0 && yields(material);
    all.push_back({yielding, values.subspan(own > 0 && material.dampingTime > 0.0 ? fem::viscousHistory : 0)});
    flows = flows || yielding;
    if (!yielding) size = std::max(size, all.back().values.size());
  });
  std::vector<MeshField> fields;
  if (flows) fields = {fieldAt(points, "plastic_strain"), fieldAt(points, "plastic_volume")};
  if (size > 0) fields.push_back(fieldAt(points, "history", static_cast<int>(size)));
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k].flows) {
      fields[0].values[k] = fem::plasticStrain(all[k].values);
      fields[1].values[k] = fem::plasticVolume(all[k].values);
    } else if (size > 0) {
      remember(fields.back(), k, all[k].values);
    }
  return fields;
}

MeshField deformationAt(const Points& points) {
  MeshField field = fieldAt(points, "deformation_gradient", 9);
  std::size_t next = 0;
  forEachPoint(points,
               [&](const Points::Part& part, std::size_t p) { matrixAt(field, next++) = deformationOf(part, p); });
  return field;
}

MeshField meansOf(const Points& points, const MeshField& field, std::size_t elements, Volumes volumes) {
  const auto n = static_cast<std::size_t>(field.components);
  MeshField means{field.name, std::vector<double>(elements * n), field.components};
  std::vector<double> weights(elements);
  std::size_t next = 0;
  forEachPoint(points, [&](const Points::Part& part, std::size_t p) {
    const auto e = static_cast<std::size_t>(part.sample.element[p]);
    const double J = volumes == Volumes::present ? deformationOf(part, p).determinant() : 1.0;
    const double weight = J * part.sample.volume[p];
    weights[e] += weight;
    for (std::size_t c = 0; c < n; ++c) means.values[n * e + c] += weight * field.values[n * next + c];
    ++next;
  });
  for (std::size_t k = 0; k < means.values.size(); ++k)
    if (const double weight = weights[k / n]; weight > 0.0) means.values[k] /= weight;
  return means;
}

}  // namespace dovetail::scene
