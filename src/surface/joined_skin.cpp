// The surface of a solid that is coupled in parts.
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/surface/skin.hpp"

namespace dovetail::surface {

namespace {

using Row = std::vector<std::pair<int, double>>;

Row rowOf(const cg::Projection& map, int row) {
  Row entries;
  for (std::size_t n = 0; n < map.rowColumns(row).size(); ++n)
    entries.emplace_back(map.rowColumns(row)[n], map.rowWeights(row)[n]);
  std::sort(entries.begin(), entries.end());
  return entries;
}

void append(cg::Projection& to, const cg::Projection& from, int row) {
  to.column.insert(to.column.end(), from.rowColumns(row).begin(), from.rowColumns(row).end());
  to.weight.insert(to.weight.end(), from.rowWeights(row).begin(), from.rowWeights(row).end());
  to.offsets.push_back(static_cast<int>(to.column.size()));
}

bool isClosed(const geometry::SurfaceTopology& topology) {
  return std::ranges::all_of(topology.neighbours, [](const auto& facet) {
    return std::ranges::all_of(facet, [](int neighbour) { return neighbour >= 0; });
  });
}

class Joiner {
public:
  explicit Joiner(std::span<const Skin* const> skins) : skins_(skins) {
    whole_.localMap.columns = whole_.carrier.columns = skins[0]->localMap.columns;
    whole_.localMap.offsets = whole_.carrier.offsets = {0};
    hasOffsets_ = std::ranges::any_of(skins, [](const Skin* skin) { return !skin->offsets.empty(); });
  }

  Skin join() {
    for (std::size_t s = 0; s < skins_.size(); ++s) add(static_cast<int>(s));
    dem::TriangulatedWall& wall = whole_.wall;
    wall.x = whole_.X;
    wall.v.assign(wall.x.size(), Vec3{});
    wall.f.assign(wall.x.size(), Vec3{});
    wall.topology = geometry::makeTopology(wall.facets, static_cast<int>(wall.x.size()));
    wall.oneSided = std::ranges::all_of(skins_, [](const Skin* skin) { return skin->wall.oneSided; }) || closesUp();
    if (corners_.size() == wall.corner.size()) wall.corner.clear();
    return std::move(whole_);
  }

private:
  void add(int s) {
    const Skin& skin = *skins_[static_cast<std::size_t>(s)];
    const auto patches = static_cast<int>(patches_), faces = static_cast<int>(whole_.faces.size());
    std::vector<int> number;
    for (int v = 0; v < static_cast<int>(skin.X.size()); ++v) number.push_back(numberOf(skin, v));
    for (fem::Face face : skin.faces) {
      for (int k = 0; k < fem::nodesOf(face.shape); ++k)
        face.node[static_cast<std::size_t>(k)] =
            number[static_cast<std::size_t>(face.node[static_cast<std::size_t>(k)])];
      requireNew(face, s);
      whole_.faces.push_back(face);
    }
    for (const geometry::Facet& facet : skin.wall.facets)
      whole_.wall.facets.push_back({number[static_cast<std::size_t>(facet[0])],
                                    number[static_cast<std::size_t>(facet[1])],
                                    number[static_cast<std::size_t>(facet[2])]});
    for (const int patch : skin.patchOfFacet) {
      whole_.patchOfFacet.push_back(patches + patch);
      patches_ = std::max(patches_, patches + patch + 1);
    }
    for (const int face : skin.facetFace) whole_.facetFace.push_back(faces + face);
    whole_.offsets.frames.insert(whole_.offsets.frames.end(), skin.offsets.frames.begin(), skin.offsets.frames.end());
  }

  /// Those that the same nodes carry are the same, whoever has them; those of kernels of their own are not.
  int numberOf(const Skin& skin, int vertex) {
    const auto v = static_cast<std::size_t>(vertex);
    const Row local = rowOf(skin.localMap, vertex);
    const Vec3 offset = skin.offsets.empty() ? Vec3{} : skin.offsets.offset[v];
    const auto next = static_cast<int>(whole_.X.size());
    const int corner = corners_.try_emplace(local, static_cast<int>(corners_.size())).first->second;
    const auto [place, isNew] = vertices_.try_emplace({local, rowOf(skin.carrier, vertex)}, next);
    if (!isNew && (!hasOffsets_ || whole_.offsets.offset[static_cast<std::size_t>(place->second)] == offset))
      return place->second;
    whole_.X.push_back(skin.X[v]);
    whole_.wall.corner.push_back(corner);
    append(whole_.localMap, skin.localMap, vertex);
    append(whole_.carrier, skin.carrier, vertex);
    if (hasOffsets_) {
      const auto frames = static_cast<int>(whole_.offsets.frames.size());
      whole_.offsets.offset.push_back(offset);
      whole_.offsets.patch.push_back(skin.offsets.empty() ? 0 : frames + skin.offsets.patch[v]);
    }
    return next;
  }

  void requireNew(const fem::Face& face, int skin) {
    std::vector<int> corners;
    for (int k = 0; k < fem::cornersOf(face.shape); ++k)
      corners.push_back(whole_.wall.corner[static_cast<std::size_t>(face.node[static_cast<std::size_t>(k)])]);
    std::sort(corners.begin(), corners.end());
    const auto [place, isNew] = owner_.try_emplace(corners, skin);
    if (isNew || place->second == skin) return;
    throw InputError("a face of the solid is in two of its couplings, numbers " + std::to_string(place->second) +
                         " and " + std::to_string(skin),
                     "surface of a solid", "give every face to one coupling");
  }

  bool closesUp() const {
    std::vector<geometry::Facet> facets = whole_.wall.facets;
    for (geometry::Facet& facet : facets)
      for (int& vertex : facet) vertex = whole_.wall.corner[static_cast<std::size_t>(vertex)];
    return isClosed(geometry::makeTopology(facets, static_cast<int>(corners_.size())));
  }

  std::span<const Skin* const> skins_;
  Skin whole_;
  std::map<Row, int> corners_;
  std::map<std::pair<Row, Row>, int> vertices_;
  std::map<std::vector<int>, int> owner_;
  bool hasOffsets_ = false;
  int patches_ = 0;
};

}  // namespace

Skin joined(std::span<const Skin* const> skins) { return Joiner(skins).join(); }

}  // namespace dovetail::surface
