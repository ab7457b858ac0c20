// Sets, supports, loads and ties of solids of a scene.
#include <algorithm>
#include <cmath>

#include "dovetail/fem/mesh/mesh_places.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "parts.hpp"
#include "supports.hpp"
#include "time_functions.hpp"

namespace dovetail::scene {

namespace {

geometry::Box extentOf(const fem::SolidMesh& mesh) {
  geometry::Box box{mesh.X.front(), mesh.X.front()};
  for (const Vec3& X : mesh.X)
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = std::min(box.lower[k], X[k]);
      box.upper[k] = std::max(box.upper[k], X[k]);
    }
  return box;
}

fem::Place placeOf(const PlaceInBox& place, const geometry::Box&) {
  return fem::inBox(place.box.lower, place.box.upper);
}
fem::Place placeOf(const PlaceOnPlane& place, const geometry::Box& extent) {
  if (norm(place.normal) == 0.0)
    throw InputError("the normal has no length", "", "give it a direction, such as [0, 0, 1]");
  const Vec3 normal = normalized(place.normal);
  const double tolerance = place.tolerance.value_or(1e-6 * norm(extent.upper - extent.lower));
  return [=, point = place.point](const Vec3& X) { return std::abs(dot(X - point, normal)) <= tolerance; };
}
fem::Place placeOf(const PlaceInSphere& place, const geometry::Box&) {
  return [=](const Vec3& X) { return norm(X - place.centre) <= place.radius; };
}
fem::Place placeOf(const PlaceAtSide& place, const geometry::Box& extent) {
  const int axis = place.side[0] - 'x';
  const bool upper = place.side[1] == '+';
  const double tolerance = 1e-6 * norm(extent.upper - extent.lower);
  const double end = upper ? extent.upper[axis] : extent.lower[axis];
  return [=](const Vec3& X) { return std::abs(X[axis] - end) <= tolerance; };
}

void add(fem::SolidMesh& mesh, const NamedSet& set) {
  if (mesh.nodeSets.contains(set.name) || mesh.faceSets.contains(set.name))
    throw InputError("the mesh already has a set \"" + set.name + "\"", "", "give this one another name");
  const fem::Place place = std::visit([&](const auto& kind) { return placeOf(kind, extentOf(mesh)); }, set.place);
  mesh.nodeSets[set.name] = fem::nodesWhere(mesh, place);
  const std::vector<fem::Face> boundary = fem::boundaryFaces(mesh);
  if (std::any_of(boundary.begin(), boundary.end(), [&](const fem::Face& face) {
        return std::all_of(face.node.begin(), face.node.begin() + fem::nodesOf(face.shape),
                           [&](int n) { return place(mesh.X[static_cast<std::size_t>(n)]); });
      }))
    mesh.faceSets[set.name] = fem::facesWhere(mesh, place);
}

/// A number, which lets the load store energy, or a function.
fem::Amplitude amplitudeOf(const TimeValue& value, const Scene& scene) {
  if (isConstant(value)) return value.number;
  return functionOf(value, scene);
}

/// Nodes that are held in all components, ascending.
std::vector<int> clampedIn(const fem::Model& model) {
  std::vector<int> nodes;
  for (std::size_t n = 0; n < model.nodes.fixed.size(); ++n)
    if (model.nodes.fixed[n] == fem::allComponents) nodes.push_back(static_cast<int>(n));
  return nodes;
}

struct Loaded {
  fem::Model& model;
  const fem::SolidMesh& mesh;
  const std::vector<fem::Face>& faces;
  std::string name;
  const Scene& scene;
};
void add(const Loaded& to, const PressureLoad& load) {
  const fem::Amplitude pressure = amplitudeOf(load.pressure, to.scene);
  if (load.follows)
    to.model.add(fem::followingPressure(to.mesh, to.faces, pressure, clampedIn(to.model), to.name));
  else
    to.model.add(fem::deadPressure(to.mesh, to.faces, pressure, to.name));
}
void add(const Loaded& to, const TractionLoad& load) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (isConstant(load.traction[c]) && load.traction[c].number == 0.0) continue;
    Vec3 direction;
    direction[static_cast<int>(c)] = 1.0;
    to.model.add(fem::deadTraction(to.mesh, to.faces, direction, amplitudeOf(load.traction[c], to.scene),
                                   to.name + " along " + "xyz"[c]));
  }
}

}  // namespace

void addSets(fem::SolidMesh& mesh, const Solid& solid) {
  for (const NamedSet& set : solid.sets) atPlace(set.where, [&] { add(mesh, set); });
}

void addBoundaries(fem::Model& model, const fem::SolidMesh& mesh, const Solid& solid, const Scene& scene,
                   std::vector<std::string>& notes) {
  Holders holders(model, mesh, solid, scene);
  for (const Support& one : solid.supports) atPlace(one.where, [&] { holders.hold(one); });
  for (const MeshTie& tie : solid.ties) atPlace(tie.where, [&] { holders.carry(tie); });
  notes.insert(notes.end(), holders.jumps().begin(), holders.jumps().end());
  for (std::size_t k = 0; k < solid.loads.size(); ++k)
    atPlace(solid.loads[k].where, [&] {
      const Load& load = solid.loads[k];
      const Loaded to{model, mesh, fem::faceSet(mesh, load.on), "load " + std::to_string(k) + " on " + load.on, scene};
      std::visit([&](const auto& kind) { add(to, kind); }, load.kind);
    });
}

}  // namespace dovetail::scene
