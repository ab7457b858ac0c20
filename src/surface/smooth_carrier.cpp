// Contacts with smooth patches.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "carried_points.hpp"
#include "carrier.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"
#include "smooth_contacts.hpp"

namespace dovetail::surface {

namespace {

/// A B-spline patch lies in the box of its control points.
geometry::Box controlBox(const SmoothSurface& surface, std::size_t face, double margin) {
  geometry::Box box{surface.x[surface.control[face][0]], surface.x[surface.control[face][0]]};
  for (int c : surface.control[face])
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = std::min(box.lower[k], surface.x[c][k]);
      box.upper[k] = std::max(box.upper[k], surface.x[c][k]);
    }
  return geometry::expanded(box, margin);
}

class SmoothCarrier final : public Carrier {
public:
  explicit SmoothCarrier(SmoothSurface surface) : surface_(std::move(surface)), all_(surface_.X.size()) {
    std::iota(all_.begin(), all_.end(), 0);
    wall_.material = surface_.material;
    outline_.oneSided = surface_.oneSided;
    for (const auto& c : surface_.control) {  // its four in the middle lie over the face's corners
      outline_.facets.push_back({c[5], c[6], c[10]});
      outline_.facets.push_back({c[5], c[10], c[9]});
    }
  }

  std::unique_ptr<Carrier> clone() const override { return std::make_unique<SmoothCarrier>(*this); }
  const cg::Projection& map() const override { return surface_.carrier; }
  const PatchOffsets& offsets() const override { return surface_.offsets; }
  std::span<const Vec3> points() const override { return surface_.x; }
  const SmoothSurface* smooth() const override { return &surface_; }

  void check(const dem::ContactLaws& laws, const geometry::Periodicity& periodicity) const override {
    const auto refuse = [](const std::string& what) {
      throw InputError(what, "smooth surface",
                       "take the facets themselves (\"surface\": \"flat\"), which have no such limits");
    };
    if (laws.memory() > 0) refuse("\"" + laws.name() + "\" has springs with memory, which patches do not carry");
    if (laws.reach() > 0.0) refuse("\"" + laws.name() + "\" acts at a distance");
    if (periodicity.any()) refuse("space is periodic");
  }

  void placeAll(std::span<const Vec3> u, std::span<const Vec3> v) override { surface::place(surface_, u, v, all_); }
  void place(std::span<const Vec3> u, std::span<const Vec3> v) override { surface::place(surface_, u, v, active_); }

  void search(const dem::Particles& particles, double margin, double, const geometry::Periodicity&) override {
    list(findPairs(particles, margin));
    findActive();
    start_.resize(face_.size());
    parallelFor(particle_.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        for (int c = offsets_[k]; c < offsets_[k + 1]; ++c)
          start_[c] = roughlyClosest(surface_, face_[c], particles.x[particle_[k]]);
    });
  }

  void findContacts(const dem::Particles& particles, double, dem::WallContacts& contacts) override {
    if (!particle_.empty() && static_cast<std::size_t>(particle_.back()) >= particles.size())
      refuse("a particle that does not exist");
    constexpr std::size_t chunkSize = 16;
    std::vector<std::vector<SmoothContact>> parts((particle_.size() + chunkSize - 1) / chunkSize);
    parallelFor(particle_.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
      thread_local SmoothScratch scratch;
      for (std::size_t k = begin; k < end; ++k) {
        const std::size_t first = static_cast<std::size_t>(offsets_[k]),
                          last = static_cast<std::size_t>(offsets_[k + 1]);
        const int i = particle_[k];
        appendSmoothContacts(surface_, i, particles.x[i], particles.radius[i],
                             std::span(face_).subspan(first, last - first),
                             std::span(start_).subspan(first, last - first), scratch, parts[begin / chunkSize]);
      }
    });
    clear(contacts);
    for (const auto& part : parts)
      for (const SmoothContact& contact : part) append(contact, contacts);
    contacts.force.assign(contacts.size(), Vec3{});
  }

  const dem::TriangulatedWall& wall() const override { return wall_; }
  const dem::TriangulatedWall& outline() override {
    outline_.x = surface_.x;
    return outline_;
  }
  void addReaction(const dem::WallContacts& contacts, coupling::NodalLoad& onPoints) const override {
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (std::size_t k = 0; k < 16; ++k)
        onPoints.add(surface_.control[contactFace_[c]][k], -contactWeight_[c][k] * contacts.force[c]);
  }
  void follow(const dem::WallContacts&, std::size_t contact,
              std::vector<std::pair<int, double>>& points) const override {
    for (std::size_t k = 0; k < 16; ++k)
      points.emplace_back(surface_.control[contactFace_[contact]][k], contactWeight_[contact][k]);
  }
  void turnWith(const dem::WallContacts&, std::size_t, std::vector<std::pair<int, double>>&) const override {}

  void save(ByteWriter& writer) const override { archive(writer, *this); }
  void load(ByteReader& reader) override {
    const std::size_t points = surface_.x.size();
    archive(reader, *this);
    requireWhole(points);
    wall_.facets.clear();
    for (int c = 0; c < static_cast<int>(contactFace_.size()); ++c) wall_.facets.push_back({c, c, c});
    findActive();
  }

private:
  [[noreturn]] static void refuse(const char* what) {
    throw InputError(std::string("a state has ").append(what), "contacts on a smooth surface",
                     "take an older checkpoint");
  }
  /// What a damaged state may not be.
  void requireWhole(std::size_t points) const {
    if (surface_.x.size() != points || surface_.v.size() != points) refuse("another number of points");
    const bool ends = offsets_.size() == particle_.size() + 1 && offsets_.front() == 0 &&
                      static_cast<std::size_t>(offsets_.back()) == face_.size() && start_.size() == face_.size();
    if (!ends || !std::is_sorted(offsets_.begin(), offsets_.end())) refuse("lists that do not fit each other");
    for (const std::size_t size : {wall_.x.size(), wall_.v.size(), contactWeight_.size()})
      if (size != contactFace_.size()) refuse("lists that do not fit each other");
    if (!std::is_sorted(particle_.begin(), particle_.end()) || (!particle_.empty() && particle_.front() < 0))
      refuse("a particle that does not exist");
    for (const auto* const faces : {&face_, &contactFace_})
      for (const int face : *faces)
        if (face < 0 || static_cast<std::size_t>(face) >= surface_.control.size())
          refuse("a patch that does not exist");
    requireFinite(surface_.x), requireFinite(surface_.v), requireFinite(wall_.x), requireFinite(wall_.v);
    for (const auto& [a, b] : start_)
      if (!std::isfinite(a + b)) refuse("a place that is not finite");
    for (const auto& weights : contactWeight_)
      for (const double weight : weights)
        if (!std::isfinite(weight)) refuse("a weight that is not finite");
  }
  static void requireFinite(std::span<const Vec3> values) {
    for (const Vec3& value : values)
      if (!isFinite(value)) refuse("a number that is not finite");
  }
  using Found = std::vector<std::array<int, 2>>;  // particle, face

  /// By face.
  std::vector<Found> findPairs(const dem::Particles& particles, double margin) const {
    constexpr std::size_t chunkSize = 64;
    geometry::HierarchicalGrid grid;
    grid.build(particles.x, particles.radius);
    std::vector<Found> parts((surface_.control.size() + chunkSize - 1) / chunkSize);
    parallelFor(surface_.control.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
      for (std::size_t face = begin; face < end; ++face)
        grid.query(controlBox(surface_, face, margin), [&](int particle) {
          parts[begin / chunkSize].push_back({particle, static_cast<int>(face)});
        });
    });
    return parts;
  }

  /// By particle, faces ascending.
  void list(const std::vector<Found>& parts) {
    Found all;
    for (const Found& part : parts) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    particle_.clear();
    offsets_.clear();
    face_.clear();
    for (const auto& [particle, face] : all) {
      if (particle_.empty() || particle_.back() != particle) {
        particle_.push_back(particle);
        offsets_.push_back(static_cast<int>(face_.size()));
      }
      face_.push_back(face);
    }
    offsets_.push_back(static_cast<int>(face_.size()));
  }

  void findActive() {
    active_.clear();
    for (int face : face_) active_.insert(active_.end(), surface_.control[face].begin(), surface_.control[face].end());
    active_ = sortedUnique(std::move(active_));
  }

  void clear(dem::WallContacts& contacts) {
    dem::clear(contacts);
    wall_.x.clear();
    wall_.v.clear();
    wall_.facets.clear();
    contactFace_.clear();
    contactWeight_.clear();
  }

  /// The wall has one vertex per contact, which is where the patch is touched.
  void append(const SmoothContact& contact, dem::WallContacts& contacts) {
    const int number = static_cast<int>(contacts.size());
    contacts.particle.push_back(contact.particle);
    contacts.facet.push_back(number);
    contacts.weight.push_back({1.0, 0.0, 0.0});
    contacts.normal.push_back(contact.normal);
    contacts.overlap.push_back(contact.overlap);
    contacts.engagement.push_back(contact.engagement);
    contacts.energyFraction.push_back(contact.energyFraction);
    Vec3 velocity;
    for (std::size_t k = 0; k < 16; ++k) velocity += contact.weight[k] * surface_.v[surface_.control[contact.face][k]];
    wall_.x.push_back(contact.foot);
    wall_.v.push_back(velocity);
    wall_.facets.push_back({number, number, number});
    contactFace_.push_back(contact.face);
    contactWeight_.push_back(contact.weight);
  }

  template <class Archive, class Self>
  static void archive(Archive& archive, Self& self) {
    archive(self.particle_, self.offsets_, self.face_, self.start_, self.wall_.x, self.wall_.v, self.contactFace_,
            self.contactWeight_, self.surface_.x, self.surface_.v);
  }

  SmoothSurface surface_;
  std::vector<int> all_, active_;                  // control points: all, those of candidates
  std::vector<int> particle_, offsets_{0}, face_;  // candidates of particle_[k]: face_[offsets_[k]] …
  std::vector<std::array<double, 2>> start_;       // per candidate: where the last search ended
  dem::TriangulatedWall wall_, outline_;
  std::vector<int> contactFace_;
  std::vector<std::array<double, 16>> contactWeight_;
};

}  // namespace

std::unique_ptr<Carrier> makeCarrier(SmoothSurface surface) {
  return std::make_unique<SmoothCarrier>(std::move(surface));
}

}  // namespace dovetail::surface
