#include "dovetail/mpm/face_contact.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::mpm {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

surface::Skin skinOf(const PointSolid* points, std::size_t set, std::span<const fem::Face> faces, double thickness,
                     int material) {
  if (points == nullptr) throw InputError("there are no points", "mpm::FaceContact", "give those of makePoints");
  const std::vector<Vec3>& X = points->markers(set).X;
  const bool plane = !faces.empty() && fem::dimensionOf(faces[0].shape) == 2;
  surface::Skin skin = plane ? surface::makeStrips(X, faces, thickness) : surface::makeSkin(X, faces);
  skin.wall.material = material;
  return skin;
}

}  // namespace

FaceContact::FaceContact(coupling::SolidSide& side, std::shared_ptr<const PointSolid> points, std::size_t set,
                         std::span<const fem::Face> faces, std::shared_ptr<const dem::ContactLaws> laws,
                         double thickness, int material, const surface::CouplingOptions& options, std::string name)
    : FaceContact(side, points, set, skinOf(points.get(), set, faces, thickness, material), std::move(laws), options,
                  std::move(name)) {}

FaceContact::FaceContact(coupling::SolidSide& side, std::shared_ptr<const PointSolid> points, std::size_t set,
                         surface::Skin skin, std::shared_ptr<const dem::ContactLaws> laws,
                         const surface::CouplingOptions& options, std::string name)
    : SurfaceContact(side, std::move(laws), std::move(name), surface::SurfaceCoupler(skin, options)),
      points_(std::move(points)),
      set_(set),
      ofMarkers_(skin.localMap),
      across_(skin.X) {
  for (std::size_t v = 0; v < across_.size(); ++v)
    across_[v] -= cg::applyRow(ofMarkers_, static_cast<int>(v), markers().X);
  carryOn();
}

void FaceContact::check(const dem::Model& m) const {
  SurfaceContact::check(m);
  for (const auto* other : m.terms.all<coupling::Connector>())
    if (other != this && other->side().model == side().model)
      throw InputError("\"" + other->name() + "\" acts on the same body of points", name(),
                       "couple it once: by faces if it keeps them, by spheres if it flows");
}

/// Tells the coupler the nodes of a grid that has been renewed.
void FaceContact::carryOn() {
  if (carriedAt_ == points_->renewals() && !fitsState_) return;
  std::vector<Vec3> X = across_;
  for (std::size_t v = 0; v < X.size(); ++v) X[v] += cg::applyRow(ofMarkers_, static_cast<int>(v), markers().X);
  coupler().carry(std::move(X), cg::product(ofMarkers_, markers().map));
  if (!fitsState_) coupler().searchAnew();
  fitsState_ = false;
  carriedAt_ = points_->renewals();
}

FaceContact::Motion FaceContact::carrying() {
  carryOn();
  const fem::Nodes& nodes = side().nodes();
  if (markers().images.empty()) return {nodes.u, nodes.v};
  u_ = withImages(markers(), nodes.u);
  v_ = withImages(markers(), nodes.v);
  return {u_, v_};
}

std::vector<double> FaceContact::ofCarrying(std::vector<double> ofNodes) const {
  for (const NodeImage& image : markers().images) ofNodes.push_back(ofNodes[at(image.node)]);
  return ofNodes;
}

void FaceContact::loadSide() {
  const coupling::NodalLoad& load = coupling().load();
  const std::size_t nodes = markers().nodes();
  const bool mirrored = !markers().images.empty();
  for (const int column : load.touched) {
    const std::size_t c = at(column);
    const NodeImage to = c < nodes ? NodeImage{column, 0} : markers().images[c - nodes];
    const Vec3 share = flipped(load.force[c], to.flip);
    side().load.add(to.node, share);
    if (mirrored) ofBorders_.add(side().nodes().X[at(to.node)] + side().nodes().u[at(to.node)], share);
  }
}

void FaceContact::addForces(dem::Model& m, const dem::Step& step) {
  ofBorders_ = {};
  SurfaceContact::addForces(m, step);
  if (markers().images.empty()) return;
  const Momenta all = onSolid({});
  ofBorders_.linear -= all.linear;
  ofBorders_.angular -= all.angular;
}

/// With what borders take of it.
Momenta FaceContact::onSolid(const Vec3& about) const {
  const dem::WallContacts& contacts = coupling().contacts();
  Momenta sum;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const geometry::Facet& facet = coupling().wall().facets[contacts.facet[c]];
    Vec3 place;
    for (std::size_t k = 0; k < 3; ++k) place += contacts.weight[c][k] * coupling().wall().x[facet[k]];
    sum.add(place - about, -1.0 * contacts.force[c]);
    if (!contacts.couple.empty()) sum.angular -= contacts.couple[c];
  }
  return sum;
}

void FaceContact::addOutside(const dem::Model&, Momenta& force, Momenta&) const { force += ofBorders_; }

void FaceContact::addDemand(const dem::Model& m, dem::ContactDemand& demand) const {
  const std::size_t first = demand.fractions.size();
  SurfaceContact::addDemand(m, demand);
  if (markers().images.empty() || demand.fractions.size() == first) return;
  const auto nodes = static_cast<int>(markers().nodes());
  const auto firstNode = static_cast<int>(demand.sides[at(side().addTo(demand))].first);
  for (std::size_t k = first; k < demand.fractions.size(); ++k)
    if (int& mass = demand.fractions[k].mass; mass >= firstNode + nodes)
      mass = firstNode + markers().images[at(mass - firstNode - nodes)].node;
}

void FaceContact::load(ByteReader& reader) {
  SurfaceContact::load(reader);
  fitsState_ = true;
}

}  // namespace dovetail::mpm
