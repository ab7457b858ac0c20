// Contact of grains with faces of a body of material points that keeps its faces.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/mpm/point_solid.hpp"
#include "dovetail/surface/surface_contact.hpp"

namespace dovetail::mpm {

/// Grains meet facets between markers as they meet the skin of a mesh: by the same laws, edges and memory, which stays
/// when the grid is renewed. The pair is adjoint. For bodies that keep their faces; what flows takes PointContact, and
/// none takes both.
class FaceContact final : public surface::SurfaceContact {
public:
  /// @param set    of markers (PointSolid::addMarkers)
  /// @param faces  between them, in markers; lines in the plane
  /// @param thickness  of the body in the plane, m
  /// @throws InputError as surface::makeSkin and SurfaceContact do, or for no points
  FaceContact(coupling::SolidSide& side, std::shared_ptr<const PointSolid> points, std::size_t set,
              std::span<const fem::Face> faces, std::shared_ptr<const dem::ContactLaws> laws, double thickness = 1.0,
              int material = 0, const surface::CouplingOptions& options = {}, std::string name = "surface contacts");

  Momenta onSolid(const Vec3& about) const override;
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<FaceContact>(*this); }
  bool followsNodes() const override { return true; }
  void check(const dem::Model& m) const override;
  void addForces(dem::Model& m, const dem::Step& step) override;
  void addDemand(const dem::Model& m, dem::ContactDemand& demand) const override;
  /// What borders of the grid take of contact forces near them, and add to them.
  void addOutside(const dem::Model& m, Momenta& force, Momenta& impulse) const override;
  void load(ByteReader& reader) override;

private:
  FaceContact(coupling::SolidSide& side, std::shared_ptr<const PointSolid> points, std::size_t set, surface::Skin skin,
              std::shared_ptr<const dem::ContactLaws> laws, const surface::CouplingOptions& options, std::string name);

  const Markers& markers() const { return points_->markers(set_); }
  Motion carrying() override;
  void loadSide() override;
  std::vector<double> ofCarrying(std::vector<double> ofNodes) const override;
  void carryOn();

  std::shared_ptr<const PointSolid> points_;
  std::size_t set_;
  cg::Projection ofMarkers_;     // vertices × markers
  std::vector<Vec3> across_;     // of vertices from the plane of the markers, m
  std::int64_t carriedAt_ = -1;  // renewals when the coupler was told its nodes
  bool fitsState_ = false;       // a state has been loaded, whose nodes are still to be told
  std::vector<Vec3> u_, v_;      // of nodes and their images
  Momenta ofBorders_;
};

}  // namespace dovetail::mpm
