// Blocks, skins and single-particle scenes that several tests share.
#pragma once

#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "dovetail/core/quaternion.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/surface/surface_coupler.hpp"

namespace dovetail::surface {

class Random {
public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
  std::vector<Vec3> field(std::size_t count, double size) {
    std::vector<Vec3> values(count);
    for (Vec3& value : values) value = vector(size);
    return values;
  }

private:
  std::mt19937 engine_;
};

inline fem::Face quad(int a, int b, int c, int d) { return {fem::FaceShape::quad4, {a, b, c, d, -1, -1, -1, -1, -1}}; }

/// A block of 4 × 4 × 2 unit bricks whose top is z = 0.
inline fem::SolidMesh unitBlock() { return fem::boxOf(fem::ElementShape::hex8, {4, 4, 2}, {0, 0, -2}, {4, 4, 0}); }

/// How a skin is carried.
struct Variant {
  std::string name;
  double width = 0.0;
  cg::KernelShape shape = cg::KernelShape::lucy;
  cg::KernelCorrection correction = cg::KernelCorrection::none;
  bool smooth = false;

  cg::SurfaceKernel kernel() const { return {{shape, 2, width}, correction}; }
};
inline std::ostream& operator<<(std::ostream& out, const Variant& variant) { return out << variant.name; }

inline std::vector<Variant> flatVariants() {
  using enum cg::KernelShape;
  using cg::KernelCorrection;
  return {{"local", 0.0},
          {"lucy", 1.3},
          {"gauss", 1.3, gauss},
          {"lucyLinear", 1.3, lucy, KernelCorrection::linear},
          {"gaussLinear", 1.3, gauss, KernelCorrection::linear},
          {"wide", 6.0},
          {"wideLinear", 6.0, lucy, KernelCorrection::linear},
          {"symmetric", 1.3, lucy, KernelCorrection::symmetric},
          {"wideSymmetric", 6.0, lucy, KernelCorrection::symmetric}};
}

inline std::vector<Variant> allVariants() {
  std::vector<Variant> all = flatVariants();
  for (Variant variant : flatVariants()) {
    variant.smooth = true;
    variant.name += "Smooth";
    all.push_back(variant);
  }
  return all;
}

/// Names of variants for parameterised tests.
struct VariantName {
  template <class Info>
  std::string operator()(const Info& info) const {
    return info.param.name;
  }
};

inline Skin carriedSkin(const fem::SolidMesh& mesh, const Variant& variant, const std::string& set = "skin") {
  Skin skin = makeSkin(mesh.X, fem::faceSet(mesh, set));
  coarseGrain(skin, variant.kernel());
  return skin;
}

/// What one exchange gave.
struct Response {
  double energy = 0.0;
  std::vector<Vec3> onParticles, onNodes;
  int contacts = 0;
};

/// On the skin that a variant says, or on the smooth surface of it.
inline SurfaceCoupler makeSeam(const fem::SolidMesh& mesh, const Variant& variant,
                               const CouplingOptions& options = {}) {
  const Skin skin = carriedSkin(mesh, variant);
  return variant.smooth ? SurfaceCoupler(makeSmoothSurface(skin), options) : SurfaceCoupler(skin, options);
}

inline Response respond(SurfaceCoupler& seam, dem::Particles particles, std::span<const Vec3> u,
                        std::span<const Vec3> v, const dem::ContactLaws& laws) {
  dem::clearForces(particles);
  Response response;
  response.energy = seam.exchange(particles, u, v, laws, 1e-3).storedEnergy();
  response.onParticles = particles.f;
  response.onNodes = seam.load().force;
  response.contacts = static_cast<int>(seam.contacts().size());
  return response;
}

inline std::shared_ptr<const dem::ContactLaws> elasticLaws(double stiffness, double restitution = 1.0) {
  return dem::makeContactLaws(dem::ElasticLaw{{stiffness, restitution}});
}

/// Moves particle 0 from `above` along `direction` until it touches, and `overlap` further.
inline void pushDown(SurfaceCoupler& seam, dem::Particles& particles, std::span<const Vec3> u, const Vec3& above,
                     const Vec3& direction, double overlap) {
  const auto laws = elasticLaws(1.0);
  const std::vector<Vec3> rest(u.size());
  const double step = 0.05 * particles.radius[0];
  const auto touches = [&](double way) {
    particles.x[0] = above + way * direction;
    return respond(seam, particles, u, rest, *laws).contacts > 0;
  };
  double way = 0.0;
  while (!touches(way) && way < 20.0 * particles.radius[0]) way += step;
  double low = way - step, high = way;
  for (int i = 0; i < 40; ++i) (touches(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  particles.x[0] = above + (high + overlap) * direction;
}

}  // namespace dovetail::surface
