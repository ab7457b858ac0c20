#include "dovetail/geometry_fcl/overlap_audit.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <memory>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/surface_checks.hpp"

namespace dovetail::geometry {

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;
using Object = fcl::CollisionObjectd;

void check(const AuditBodies& bodies) {
  if (bodies.centre.size() != bodies.radius.size())
    throw InputError("there are " + std::to_string(bodies.centre.size()) + " centres and " +
                         std::to_string(bodies.radius.size()) + " radii",
                     "overlap audit", "give one of each per sphere");
  for (std::size_t i = 0; i < bodies.centre.size(); ++i) {
    if (!isFinite(bodies.centre[i]))
      throw InputError("not a finite vector", "sphere " + std::to_string(i) + ", centre", "give three finite numbers");
    requirePositive(bodies.radius[i], "radius of sphere " + std::to_string(i));
  }
}

fcl::Vector3d vector(const Vec3& a) { return {a.x, a.y, a.z}; }

/// A mesh as FCL has it, and whether it is solid.
struct Body {
  std::shared_ptr<Model> model;
  bool solid = false;
};

Body makeBody(const TriangleMesh& mesh, std::size_t number) {
  const std::string where = "mesh " + std::to_string(number);
  if (mesh.facets.empty()) throw InputError("the mesh has no facets", where, "give one with facets");
  const SurfaceDefects defects = checkSurface(mesh.x, mesh.facets);
  Body body{std::make_shared<Model>(), defects.closedAndOriented() && defects.insideOut.empty()};
  std::vector<fcl::Vector3d> points;
  for (const Vec3& x : mesh.x) points.push_back(vector(x));
  std::vector<fcl::Triangle> triangles;
  for (const Facet& f : mesh.facets)
    triangles.emplace_back(static_cast<std::size_t>(f[0]), static_cast<std::size_t>(f[1]),
                           static_cast<std::size_t>(f[2]));
  if (body.model->beginModel() != fcl::BVH_OK || body.model->addSubModel(points, triangles) != fcl::BVH_OK ||
      body.model->endModel() != fcl::BVH_OK)
    throw Error("FCL cannot take a mesh", where, "check it with checkSurface");
  return body;
}

/// Whether one body lies within the other, solid one.
bool within(const AuditBodies& bodies, const std::vector<Body>& solids, int inner, int outer) {
  const int spheres = static_cast<int>(bodies.centre.size());
  if (outer < spheres || !solids[static_cast<std::size_t>(outer - spheres)].solid) return false;
  const TriangleMesh& mesh = bodies.mesh[static_cast<std::size_t>(outer - spheres)];
  const Vec3 point =
      inner < spheres
          ? bodies.centre[static_cast<std::size_t>(inner)]
          : bodies.mesh[static_cast<std::size_t>(inner - spheres)]
                .x[static_cast<std::size_t>(bodies.mesh[static_cast<std::size_t>(inner - spheres)].facets[0][0])];
  return windingNumber(mesh.x, mesh.facets, point) > 0.5;
}

struct Audit {
  const AuditBodies& bodies;
  const std::vector<Body>& solids;
  std::vector<std::array<int, 2>> found;

  /// Called for each pair whose boxes meet; false = go on.
  static bool visit(Object* first, Object* second, void* self) {
    auto& audit = *static_cast<Audit*>(self);
    const auto number = [](Object* o) { return static_cast<int>(reinterpret_cast<std::intptr_t>(o->getUserData())); };
    const int i = std::min(number(first), number(second)), j = std::max(number(first), number(second));
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    if (fcl::collide(first, second, request, result) > 0 || within(audit.bodies, audit.solids, i, j) ||
        within(audit.bodies, audit.solids, j, i))
      audit.found.push_back({i, j});
    return false;
  }
};

}  // namespace

std::vector<std::array<int, 2>> auditOverlaps(const AuditBodies& bodies) {
  check(bodies);
  std::vector<Body> solids;
  for (std::size_t m = 0; m < bodies.mesh.size(); ++m) solids.push_back(makeBody(bodies.mesh[m], m));
  std::vector<std::unique_ptr<Object>> objects;
  const auto add = [&](std::shared_ptr<fcl::CollisionGeometryd> shape, const fcl::Vector3d& place) {
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.translation() = place;
    objects.push_back(std::make_unique<Object>(std::move(shape), pose));
    objects.back()->setUserData(reinterpret_cast<void*>(static_cast<std::intptr_t>(objects.size() - 1)));
  };
  for (std::size_t i = 0; i < bodies.centre.size(); ++i)
    add(std::make_shared<fcl::Sphered>(bodies.radius[i]), vector(bodies.centre[i]));
  for (const Body& body : solids) add(body.model, fcl::Vector3d::Zero());
  fcl::DynamicAABBTreeCollisionManagerd manager;
  for (const auto& object : objects) manager.registerObject(object.get());
  manager.setup();
  Audit audit{bodies, solids, {}};
  manager.collide(&audit, &Audit::visit);
  std::sort(audit.found.begin(), audit.found.end());
  return audit.found;
}

}  // namespace dovetail::geometry
