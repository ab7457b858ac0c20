#include "dovetail/geometry/surface_checks.hpp"

#include <algorithm>

#include "closed_patches.hpp"
#include "half_edges.hpp"

namespace dovetail::geometry {

namespace {

void checkShapes(std::span<const Vec3> x, std::span<const Facet> facets, double needleRatio, SurfaceDefects& defects) {
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const int facet = static_cast<int>(i);
    const double height = relativeHeight(x, facets[i]);
    if (repeatsVertex(facets[i]))
      defects.repeatedVertex.push_back(facet);
    else if (!(height > roundOffHeight))
      defects.zeroArea.push_back(facet);
    else if (height < needleRatio)
      defects.needle.push_back(facet);
  }
}

void checkEdges(std::span<const Facet> facets, SurfaceDefects& defects) {
  forEachEdgeGroup(sortedEdges(facets), [&](std::span<const HalfEdge> group) {
    const bool flipped = group.size() == 2 && sameSense(facets, group[0], group[1]);
    for (const HalfEdge& e : group) {
      if (group.size() == 1) defects.boundary.push_back({e.facet, e.edge});
      if (group.size() > 2) defects.nonManifold.push_back({e.facet, e.edge});
      if (flipped) defects.flipped.push_back({e.facet, e.edge});
    }
  });
  for (auto* list : {&defects.boundary, &defects.nonManifold, &defects.flipped}) std::sort(list->begin(), list->end());
}

void checkDuplicates(std::span<const Facet> facets, SurfaceDefects& defects) {
  std::vector<std::pair<Facet, int>> sorted;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    sorted.emplace_back(facets[i], static_cast<int>(i));
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t first = 0, i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[first].first)
      defects.duplicate.push_back({sorted[i].second, sorted[first].second});
    else
      first = i;
  std::sort(defects.duplicate.begin(), defects.duplicate.end());
}

void checkUse(std::size_t vertices, std::span<const Facet> facets, SurfaceDefects& defects) {
  std::vector<char> used(vertices, 0);
  for (const Facet& f : facets)
    for (const int v : f) used[at(v)] = 1;
  for (std::size_t v = 0; v < vertices; ++v)
    if (!used[v]) defects.unusedVertex.push_back(static_cast<int>(v));
}

void checkSides(std::span<const Vec3> x, std::span<const Facet> facets, SurfaceDefects& defects) {
  const Patches patches = findPatches(facets);
  std::vector<std::vector<int>> closed;
  for (std::size_t p = 0; p < patches.facets.size(); ++p) {
    const bool asOne = std::none_of(patches.facets[p].begin(), patches.facets[p].end(),
                                    [&](int f) { return patches.turned[at(f)] != 0; });
    if (patches.closed[p] && patches.oriented[p] && asOne) closed.push_back(patches.facets[p]);
  }
  for (const int p : wrongSideOut(x, facets, closed)) defects.insideOut.push_back(closed[at(p)].front());
}

void addName(std::string& text, int item) { (text += ' ') += std::to_string(item); }
void addName(std::string& text, const std::array<int, 2>& pair) {
  text += " (";
  text += std::to_string(pair[0]);
  text += ", ";
  text += std::to_string(pair[1]);
  text += ')';
}

template <class Item>
void addLine(std::string& text, const char* what, const std::vector<Item>& list) {
  if (list.empty()) return;
  constexpr std::size_t shown = 5;
  if (!text.empty()) text += "\n";
  text += std::to_string(list.size());
  ((text += ' ') += what) += ':';
  for (std::size_t i = 0; i < std::min(shown, list.size()); ++i) addName(text, list[i]);
  if (list.size() > shown) text += " …";
}

}  // namespace

SurfaceDefects checkSurface(std::span<const Vec3> x, std::span<const Facet> facets, double needleRatio) {
  checkVertices(x);
  checkIndices(facets, static_cast<int>(x.size()));
  SurfaceDefects defects;
  checkShapes(x, facets, needleRatio, defects);
  checkEdges(facets, defects);
  checkDuplicates(facets, defects);
  checkUse(x.size(), facets, defects);
  checkSides(x, facets, defects);
  defects.selfIntersection = selfIntersections(x, facets);
  return defects;
}

std::string describe(const SurfaceDefects& defects) {
  std::string text;
  addLine(text, "facets name a vertex twice", defects.repeatedVertex);
  addLine(text, "facets have no area", defects.zeroArea);
  addLine(text, "facets are needles", defects.needle);
  addLine(text, "facets are there twice (facet, earlier one)", defects.duplicate);
  addLine(text, "edges are open (facet, edge)", defects.boundary);
  addLine(text, "edges belong to more than two facets (facet, edge)", defects.nonManifold);
  addLine(text, "edges join facets of opposite sense (facet, edge)", defects.flipped);
  addLine(text, "pairs of facets intersect", defects.selfIntersection);
  addLine(text, "closed patches are inside out (first facet)", defects.insideOut);
  addLine(text, "vertices belong to no facet", defects.unusedVertex);
  return text.empty() ? "no defects" : text;
}

}  // namespace dovetail::geometry
