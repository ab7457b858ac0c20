// Sets, supports, loads and ties of solids of a scene.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

#include "changes.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_places.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/mpm/markers.hpp"
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

/// Elements all of whose nodes are in a set.
std::vector<int> elementsOn(const fem::SolidMesh& mesh, const std::vector<int>& nodes) {
  std::vector<char> isIn(mesh.X.size(), 0);
  for (const int n : nodes) isIn[static_cast<std::size_t>(n)] = 1;
  std::vector<int> elements;
  int next = 0;
  for (const fem::ElementGroup& group : mesh.groups) {
    const auto corners = static_cast<std::ptrdiff_t>(fem::nodesOf(group.shape));
    for (auto at = group.node.begin(); at != group.node.end(); at += corners, ++next)
      if (std::all_of(at, at + corners, [&](int n) { return isIn[static_cast<std::size_t>(n)] != 0; }))
        elements.push_back(next);
  }
  return elements;
}

/// Of the boundary; faces of material points are a mesh of these alone.
std::vector<fem::Face> outsideOf(const fem::SolidMesh& mesh) {
  return mesh.groups.empty() ? fem::faceSet(mesh, "skin") : fem::boundaryFaces(mesh);
}

/// Of a flat face with these corners; outwards.
Vec3 normalOf(const fem::SolidMesh& mesh, const fem::Face& face) {
  const auto corner = [&](std::size_t k) { return mesh.X[static_cast<std::size_t>(face.node[k])]; };
  if (fem::dimensionOf(face.shape) == 2) return cross(corner(1) - corner(0), Vec3{0, 0, 1});
  const std::size_t last = static_cast<std::size_t>(fem::cornersOf(face.shape)) - 1;
  return cross(corner(last == 3 ? 2 : 1) - corner(0), corner(last) - corner(last == 3 ? 1 : 0));
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
  return [=](const Vec3& X) {
    const double r = norm(X - place.centre);
    return r <= place.radius && r >= place.innerRadius;
  };
}
fem::Place placeOf(const PlaceInCylinder& place, const geometry::Box&) {
  if (norm(place.axis) == 0.0) throw InputError("the axis has no length", "", "give it a direction, such as [0, 0, 1]");
  return [=, axis = normalized(place.axis)](const Vec3& X) {
    const double r = norm(cross(axis, X - place.point));
    return r <= place.radius && r >= place.innerRadius;
  };
}
fem::Place placeOf(const PlaceAtSide& place, const geometry::Box& extent) {
  const int axis = place.side[0] - 'x';
  const bool upper = place.side[1] == '+';
  const double tolerance = 1e-6 * norm(extent.upper - extent.lower);
  const double end = upper ? extent.upper[axis] : extent.lower[axis];
  return [=](const Vec3& X) { return std::abs(X[axis] - end) <= tolerance; };
}

template <class Kind>
void add(fem::SolidMesh& mesh, const std::string& name, const Kind& kind) {
  const fem::Place place = placeOf(kind, extentOf(mesh));
  mesh.nodeSets[name] = fem::nodesWhere(mesh, place);
  if (std::vector<int> elements = elementsOn(mesh, mesh.nodeSets[name]); !elements.empty())
    mesh.elementSets[name] = std::move(elements);
  std::vector<fem::Face> faces = outsideOf(mesh);
  std::erase_if(faces, [&](const fem::Face& face) {
    return !std::all_of(face.node.begin(), face.node.begin() + fem::nodesOf(face.shape),
                        [&](int n) { return place(mesh.X[static_cast<std::size_t>(n)]); });
  });
  if (!faces.empty()) mesh.faceSets[name] = std::move(faces);
}

void add(fem::SolidMesh& mesh, const std::string& name, const FacesTowards& kind) {
  if (norm(kind.direction) == 0.0)
    throw InputError("the direction has no length", "", "give it one, such as [0, 0, 1]");
  std::vector<fem::Face> faces = outsideOf(mesh);
  const Vec3 direction = normalized(kind.direction);
  std::erase_if(faces, [&](const fem::Face& face) {
    const Vec3 normal = normalOf(mesh, face);
    return std::atan2(norm(cross(normal, direction)), dot(normal, direction)) > kind.angle;
  });
  if (faces.empty())
    throw InputError("no face of the boundary looks in this direction", "", "widen the angle, or turn the direction");
  std::set<int> nodes;
  for (const fem::Face& face : faces) nodes.insert(face.node.begin(), face.node.begin() + fem::nodesOf(face.shape));
  mesh.nodeSets[name] = {nodes.begin(), nodes.end()};
  mesh.faceSets[name] = std::move(faces);
}

/// Of what both sets have: nodes, faces, elements.
void add(fem::SolidMesh& mesh, const std::string& name, const CommonPart& kind) {
  const auto common = [&](auto& sets, const auto& same) {
    const auto a = sets.find(kind.of), b = sets.find(kind.with);
    if (a == sets.end() || b == sets.end()) return;
    auto both = a->second;
    std::erase_if(both, [&](const auto& one) {
      return std::ranges::none_of(b->second, [&](const auto& other) { return same(one, other); });
    });
    if (!both.empty()) sets[name] = std::move(both);
  };
  for (const std::string& part : {kind.of, kind.with})
    if (!mesh.nodeSets.contains(part) && !mesh.elementSets.contains(part)) fem::nodeSet(mesh, part);  // refuses
  common(mesh.nodeSets, std::equal_to<>());
  common(mesh.elementSets, std::equal_to<>());
  common(mesh.faceSets, [](const fem::Face& a, const fem::Face& b) { return a.node == b.node; });
  if (!mesh.nodeSets.contains(name) && !mesh.elementSets.contains(name))
    throw InputError("\"" + kind.of + "\" and \"" + kind.with + "\" have nothing in common", "", "name sets that meet");
}

void add(fem::SolidMesh& mesh, const NamedSet& set) {
  if (mesh.nodeSets.contains(set.name) || mesh.faceSets.contains(set.name) || mesh.elementSets.contains(set.name))
    throw InputError("the mesh already has a set \"" + set.name + "\"", "", "give this one another name");
  std::visit([&](const auto& kind) { add(mesh, set.name, kind); }, set.place);
}

struct Loaded {
  const LoadedFaces& body;
  const std::string& on;
  std::string name;
  const Scene& scene;
  const Solid& solid;
  ChangingParts& changing;
  const std::vector<fem::Face>& faces() const { return fem::faceSet(body.mesh, on); }
};

/// A number, which lets the load store energy, or a function; of a load that stages change, one that they exchange.
fem::Amplitude amplitudeOf(const Loaded& to, const Load& load, const TimeValue& value, int component) {
  if (isChanged(load, to.solid, to.scene)) {
    const auto now = std::make_shared<TimeFunction>(functionOf(value, to.scene));
    if (!to.changing.loads.emplace(keyOfLoad(to.solid.name, load, component), now).second)
      throw InputError("a stage changes one of two loads of this kind on " + load.on, "", "join the two");
    return [now](double t) { return (*now)(t); };
  }
  if (isConstant(value)) return value.number;
  return functionOf(value, to.scene);
}

/// Nodes that are held in all components throughout, ascending.
std::vector<int> clampedIn(const fem::Model& model, const Solid& solid, const Scene& scene) {
  std::vector<int> nodes;
  if (changesSupports(solid, scene)) return nodes;
  for (std::size_t n = 0; n < model.nodes.fixed.size(); ++n)
    if (model.nodes.fixed[n] == fem::allComponents) nodes.push_back(static_cast<int>(n));
  return nodes;
}

void add(const Loaded& to, const Load& all, const PressureLoad& load) {
  if (usesPlace(load.pressure)) {
    if (isChanged(all, to.solid, to.scene))
      throw InputError("a load of the place cannot change", "", "leave x, y and z out of it, or leave it as it is");
    const PlaceFunction pressure = fieldOf(load.pressure, to.scene);
    to.body.add(load.follows ? fem::followingPressure(to.body.mesh, to.faces(), pressure, to.name)
                             : fem::deadPressure(to.body.mesh, to.faces(), pressure, to.name));
    return;
  }
  const fem::Amplitude pressure = amplitudeOf(to, all, load.pressure, 0);
  if (load.follows)
    to.body.add(fem::followingPressure(to.body.mesh, to.faces(), pressure, to.body.clamped, to.name));
  else
    to.body.add(fem::deadPressure(to.body.mesh, to.faces(), pressure, to.name));
}
void add(const Loaded& to, const Load& all, const NodalLoad& load) {
  const std::vector<int>& nodes = fem::nodeSet(to.body.mesh, to.on);
  for (std::size_t c = 0; c < 3; ++c) {
    if (isConstant(load.force[c]) && load.force[c].number == 0.0 && !isChanged(all, to.solid, to.scene)) continue;
    Vec3 part;
    part[static_cast<int>(c)] = 1.0 / static_cast<double>(nodes.size());
    to.body.add(fem::nodalForce(nodes, part, amplitudeOf(to, all, load.force[c], static_cast<int>(c)),
                                to.name + " along " + "xyz"[c]));
  }
}
void add(const Loaded& to, const Load& all, const TractionLoad& load) {
  if (usesPlace(load.traction)) {
    if (isChanged(all, to.solid, to.scene))
      throw InputError("a load of the place cannot change", "", "leave x, y and z out of it, or leave it as it is");
    const std::array<PlaceFunction, 3> part{fieldOf(load.traction[0], to.scene), fieldOf(load.traction[1], to.scene),
                                            fieldOf(load.traction[2], to.scene)};
    to.body.add(fem::deadTraction(
        to.body.mesh, to.faces(),
        [part](const Vec3& X, double t) {
          return Vec3{part[0](X, t), part[1](X, t), part[2](X, t)};
        },
        to.name));
    return;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    if (isConstant(load.traction[c]) && load.traction[c].number == 0.0 && !isChanged(all, to.solid, to.scene)) continue;
    Vec3 direction;
    direction[static_cast<int>(c)] = 1.0;
    to.body.add(fem::deadTraction(to.body.mesh, to.faces(), direction,
                                  amplitudeOf(to, all, load.traction[c], static_cast<int>(c)),
                                  to.name + " along " + "xyz"[c]));
  }
}

/// Of the stiffest material behind some faces, Pa/m.
double stiffestPenalty(const fem::SolidMesh& mesh, const std::vector<fem::Face>& faces, const Solid& solid,
                       const Built& built) {
  if (mesh.groups.empty())  // of material points, which have one material
    return fem::contactPenalty(mesh, faces, confinedModulusOf(solid.material, built));
  std::vector<char> isOnFace(mesh.X.size(), 0);
  for (const fem::Face& face : faces)
    for (int k = 0; k < fem::nodesOf(face.shape); ++k)
      isOnFace[static_cast<std::size_t>(face.node[static_cast<std::size_t>(k)])] = 1;
  const std::vector<std::size_t> material = materialByElement(solid, mesh);
  const std::vector<const SolidMaterial*> materials = materialsOf(solid);
  std::set<std::size_t> behind;
  std::size_t element = 0;
  for (const fem::ElementGroup& group : mesh.groups)
    for (std::size_t e = 0; e < group.size(); ++e, ++element) {
      const auto nodes = static_cast<std::size_t>(fem::nodesOf(group.shape));
      const auto first = group.node.begin() + static_cast<std::ptrdiff_t>(e * nodes);
      // As many nodes as a face has at least: 3, in plane strain 2.
      if (std::count_if(first, first + static_cast<std::ptrdiff_t>(nodes),
                        [&](int n) { return isOnFace[static_cast<std::size_t>(n)] != 0; }) >= fem::dimensionOf(mesh))
        behind.insert(material[element]);
    }
  double largest = 0.0;
  for (const std::size_t m : behind)
    largest = std::max(largest, fem::contactPenalty(mesh, faces, confinedModulusOf(*materials[m], built)));
  return largest;
}

void add(const LoadedFaces& body, const Solid& solid, std::size_t number, const Scene& scene, Built& built) {
  const fem::SolidMesh& mesh = body.mesh;
  const SolidPlane& plane = solid.planes[number];
  if (norm(plane.normal) == 0.0)
    throw InputError("the normal has no length", "", "give it a direction, such as [0, 0, 1]");
  const std::vector<fem::Face>& faces = fem::faceSet(mesh, plane.on);
  fem::ContactOptions options{.penalty = plane.stiffness.number,
                              .friction = plane.friction,
                              .name = "plane " + std::to_string(number) + " on " + plane.on};
  // With ten times the modulus explicit steps would be a third as long.
  if (!plane.stiffness.word.empty())
    options.penalty = (solid.implicitSteps ? 1.0 : 0.1) * stiffestPenalty(mesh, faces, solid, built);
  fem::Plane rigid{.point = plane.point, .normal = plane.normal};
  const bool moves = plane.displacement || !isConstant(plane.velocity) || norm(constantOf(plane.velocity)) > 0.0;
  const auto path = pathOf(plane.velocity, plane.displacement, scene, stepOf(*built.run)).displacement;
  if (isPlaneChanged(solid.name, number, scene)) {
    const auto now = std::make_shared<std::function<Vec3(double)>>(path);
    built.changing.planes[keyOfPlane(solid.name, number)] = now;
    rigid.motion = [now](double t) { return (*now)(t); };
  } else if (moves) {
    rigid.motion = path;
  }
  if (!solid.state &&
      std::ranges::all_of(mesh.X, [&](const Vec3& X) { return dot(X - plane.point, plane.normal) < 0.0; }))
    throw InputError("all of \"" + solid.name + "\" lies behind the plane", "",
                     "turn its normal round, or move its point");
  body.add(fem::makeContactPlane(mesh, faces, rigid, options));
}

}  // namespace

bool hasStatics(const Scene& scene) {
  return std::ranges::any_of(scene.stages,
                             [](const Stage& stage) { return std::holds_alternative<Statics>(stage.kind); });
}

void addSets(fem::SolidMesh& mesh, const Solid& solid) {
  for (const NamedSet& set : solid.sets) atPlace(set.where, [&] { add(mesh, set); });
}

void addBoundaries(fem::Model& model, const fem::SolidMesh& mesh, const Solid& solid, const Scene& scene,
                   Built& built) {
  std::vector<SupportNow>& supports = built.supports.emplace_back(supportsOf(solid));
  if (changesSupports(solid, scene))
    for (SupportNow& one : supports) one.from = std::make_shared<const std::vector<Vec3>>(model.nodes.u);
  const auto jumps = putHolders(model, mesh, solid, scene, stepOf(*built.run), supports);
  built.notes.insert(built.notes.end(), jumps.begin(), jumps.end());
  const LoadedFaces faces{mesh, clampedIn(model, solid, scene), [&](auto term) { model.add(std::move(term)); }};
  addLoads(faces, solid, scene, built);
  if (solid.massDamping > 0.0) model.add(fem::massDamping(solid.massDamping));
  addPlanes(faces, solid, scene, built);
}

void addLoads(const LoadedFaces& body, const Solid& solid, const Scene& scene, Built& built) {
  for (std::size_t k = 0; k < solid.loads.size(); ++k)
    atPlace(solid.loads[k].where, [&] {
      const Load& load = solid.loads[k];
      const Loaded to{body, load.on, "load " + std::to_string(k) + " on " + load.on, scene, solid, built.changing};
      std::visit([&](const auto& kind) { add(to, load, kind); }, load.kind);
    });
}

std::vector<fem::ContactPlane::Report> planeReports(const fem::Model& model) {
  std::vector<fem::ContactPlane::Report> reports;
  for (const auto& term : model.terms) {
    const auto* const carried = dynamic_cast<const mpm::MarkerTerm*>(term.get());
    const auto* const plane = dynamic_cast<const fem::ContactPlane*>(carried ? &carried->term() : term.get());
    if (plane) reports.push_back(plane->report(carried ? carried->seen(model.nodes) : model.nodes, {.t = model.t}));
  }
  return reports;
}

void addPlanes(const LoadedFaces& body, const Solid& solid, const Scene& scene, Built& built) {
  for (std::size_t k = 0; k < solid.planes.size(); ++k)
    atPlace(solid.planes[k].where, [&] { add(body, solid, k, scene, built); });
}

}  // namespace dovetail::scene
