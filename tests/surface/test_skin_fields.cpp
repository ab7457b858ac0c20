// Continuum fields of grains that touch a deformable skin.
#include <gtest/gtest.h>

#include "contact_scene.hpp"
#include "dovetail/cg/fields.hpp"
#include "dovetail/cg/wall_traction.hpp"
#include "dovetail/dem/model/snapshot.hpp"

namespace dovetail::surface {
namespace {

TEST(SkinFields, BalanceWithTheContactsOfTheSkinAndTractionsCarryThem) {
  const fem::SolidMesh mesh = softBlock(fem::ElementShape::hex8);
  for (const Variant& variant : {Variant{"local"}, Variant{"lucy", 0.2}}) {
    ContactScene scene(mesh, slantingGrains(40, 3), rollingLaws(), variant);
    scene.start(1e-4);
    for (int step = 0; step < 150; ++step) scene.step(1e-4);
    dem::findForces(scene.grains);
    const SurfaceCoupler& coupling = scene.contact->coupling();
    dem::Snapshot now = dem::takeSnapshot(scene.grains);
    ASSERT_GT(now.wallPoint.size(), 5u) << variant.name;
    for (std::size_t i = 0; i < now.x.size(); ++i) now.v[i] = scene.grains.particles.f[i] / now.mass[i];

    // Σ F W = ∇·σ + t on both sides of the skin, by central differences.
    const cg::Kernel kernel{cg::KernelShape::lucy, 3, 0.12};
    const double h = 1e-4;
    Random random(5);
    double worst = 0.0, size = 0.0;
    for (int trial = 0; trial < 30; ++trial) {
      const Vec3 x{random(0.05, 0.5), random(0.05, 0.5), random(-0.05, 0.1)};
      const std::vector<Vec3> points{x,
                                     x + Vec3{h, 0, 0},
                                     x - Vec3{h, 0, 0},
                                     x + Vec3{0, h, 0},
                                     x - Vec3{0, h, 0},
                                     x + Vec3{0, 0, h},
                                     x - Vec3{0, 0, h}};
      const cg::Fields fields = cg::sample(kernel, points, cg::viewOf(now));
      const Vec3 known = fields.momentum[0] - fields.wallForce[0];
      Eigen::Vector3d sum(known.x, known.y, known.z);
      for (std::size_t k = 0; k < 3; ++k)
        sum -= (fields.contactStress[2 * k + 1] - fields.contactStress[2 * k + 2]).col(static_cast<int>(k)) / (2.0 * h);
      worst = std::max(worst, sum.norm());
      size = std::max({size, norm(fields.momentum[0]), norm(fields.wallForce[0])});
    }
    EXPECT_LT(worst, 1e-4 * size) << variant.name;

    const cg::SurfaceKernel spread{{cg::KernelShape::lucy, 2, 0.2}, cg::KernelCorrection::none};
    const dem::TriangulatedWall& skin = coupling.wall();
    const cg::VertexTraction t =
        cg::wallTraction(spread, skin.x, skin.facets, coupling.skin().patchOfFacet,
                         {coupling.contacts().facet, coupling.contacts().weight, coupling.contacts().force});
    Vec3 carried, wanted;
    for (std::size_t v = 0; v < t.area.size(); ++v) carried += t.area[v] * t.traction[v];
    for (const Vec3& f : now.wallForce) wanted -= f;
    EXPECT_LT(norm(carried - wanted), 1e-12 * norm(wanted)) << variant.name;
  }
}

}  // namespace
}  // namespace dovetail::surface
