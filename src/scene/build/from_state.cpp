#include "from_state.hpp"

#include <algorithm>
#include <set>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/scene/read.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "keys/advice.hpp"
#include "keys/fields.hpp"
#include "parts.hpp"
#include "run/checkpoints.hpp"

namespace dovetail::scene {

namespace {

template <class Part>
std::string textOfPart(Part part) {
  return textOf([&](Fields& fields) { describe(fields, part); });
}

Scene sceneOf(const Checkpoint& checkpoint, const std::string& file) {
  return sceneFromText(checkpoint.scene, file, std::filesystem::path(file).parent_path());
}

const Solid* solidIn(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.solids, name, &Solid::name);
  return found == scene.solids.end() ? nullptr : &*found;
}

void requireSame(const Solid& there, const Solid& here, const std::string& file) {
  if (const std::string material = textOfPart(there.material); material != textOfPart(here.material))
    throw InputError("the material of \"" + here.name + "\" differs from that of the state", file,
                     "write \"material\": " + material.substr(0, material.find_last_not_of('\n') + 1));
  const auto sameRegions = [&] {
    if (there.regions.size() != here.regions.size()) return false;
    const auto setNamed = [](const Solid& solid, const std::string& name) {
      const auto found = std::ranges::find(solid.sets, name, &NamedSet::name);
      return found == solid.sets.end() ? std::string() : textOfPart(*found);
    };
    for (std::size_t k = 0; k < here.regions.size(); ++k)
      if (textOfPart(there.regions[k]) != textOfPart(here.regions[k]) ||
          setNamed(there, here.regions[k].elements) != setNamed(here, here.regions[k].elements))
        return false;
    return true;
  };
  if (!sameRegions())
    throw InputError("the regions of \"" + here.name + "\" differ from those of the state", file,
                     "give the solid the regions of the state, and their sets");
  if (there.formulation != here.formulation)
    throw InputError("the elements of \"" + here.name + "\" differ from those of the state", file,
                     "write \"formulation\": \"" + there.formulation + "\"");
}

void requireSameMesh(const coupling::SolidOfState& there, std::uint64_t fingerprint, const fem::Nodes& nodes,
                     const std::string& file) {
  const std::size_t count = there.motion.u.size();
  if (count != nodes.X.size())
    throw InputError("the mesh of \"" + there.name + "\" has " + std::to_string(nodes.X.size()) +
                         " nodes, that of the state " + std::to_string(count),
                     file, "give the solid the mesh of the state");
  if (fingerprint != fingerprintOf(nodes.X))
    throw InputError("the nodes of \"" + there.name + "\" have other positions in the mesh of the state", file,
                     "give the solid the mesh of the state");
}

/// What the state remembers of the contacts on a set.
const dem::TermOfState* memoryOf(const surface::SurfaceContact& contact, const std::vector<dem::TermOfState>& terms) {
  const auto found = std::ranges::find(terms, contact.name(), &dem::TermOfState::name);
  return found == terms.end() ? nullptr : &*found;
}

bool isOfState(const Coupling& coupling, const Scene& scene, const Scene& there, const std::string& file) {
  const Solid *const here = solidIn(scene, coupling.solid), *const before = solidIn(there, coupling.solid);
  if (!here || !before || !here->state || here->state->file != file) return false;
  if (here->sets.size() != before->sets.size()) return false;
  for (std::size_t k = 0; k < here->sets.size(); ++k)
    if (textOfPart(here->sets[k]) != textOfPart(before->sets[k])) return false;
  return std::ranges::any_of(there.couplings,
                             [&](const Coupling& one) { return textOfPart(one) == textOfPart(coupling); });
}

/// @return what begins anew, for a note
std::vector<std::string> takeSurfaceContacts(Built& built, const Scene& scene, const Scene& there,
                                             const std::string& file, const std::vector<dem::TermOfState>& terms) {
  std::vector<std::string> anew;
  const auto contacts = built.run->grains.terms.all<surface::SurfaceContact>();
  std::size_t next = 0;
  for (const Coupling& coupling : scene.couplings) {
    if (!std::holds_alternative<SurfaceContact>(coupling.kind)) continue;
    surface::SurfaceContact& contact = *contacts[next++];
    const dem::TermOfState* const memory = isOfState(coupling, scene, there, file) ? memoryOf(contact, terms) : nullptr;
    if (!memory) {
      anew.push_back(contact.name());
      continue;
    }
    ByteReader reader(memory->bytes);
    contact.load(reader);
  }
  return anew;
}

bool beginWith(const std::vector<std::int64_t>& all, const std::vector<std::int64_t>& first) {
  return all.size() >= first.size() && std::equal(first.begin(), first.end(), all.begin());
}

void note(Built& built, const std::string& what) {
  built.notes.push_back(what + " start without the tangential springs that the state may have there.");
}

}  // namespace

void takeSolid(fem::Model& model, const Solid& solid, std::vector<std::string>& notes) {
  const std::string& file = solid.state->file;
  const Checkpoint checkpoint = loadCheckpoint(file);
  const std::vector<coupling::SolidOfState> solids = coupling::solidsOf(checkpoint.state);
  const auto found = std::ranges::find(solids, solid.name, &coupling::SolidOfState::name);
  const Scene there = sceneOf(checkpoint, file);
  const Solid* const before = solidIn(there, solid.name);
  if (found == solids.end() || !before || checkpoint.meshes.size() != solids.size()) {
    std::vector<std::string> names;
    for (const auto& one : solids) names.push_back(one.name);
    throw InputError("the state has no solid \"" + solid.name + "\"", file,
                     names.empty() ? "give the state of a run with solids" : adviceFor(solid.name, names));
  }
  requireSameMesh(*found, checkpoint.meshes[static_cast<std::size_t>(found - solids.begin())], model.nodes, file);
  requireSame(*before, solid, file);
  fem::adopt(found->motion, model);
  for (Vec3& v : model.nodes.v) v += solid.velocity;
  notes.push_back("Solid \"" + solid.name + "\" is that of a run at " + formatNumber(checkpoint.time) + " s.");
}

namespace {

std::set<std::string> openSides(const Wall& wall) {
  const auto* const box = std::get_if<BoxWalls>(&wall.shape);
  return box ? std::set<std::string>(box->open.begin(), box->open.end()) : std::set<std::string>();
}

std::size_t primitivesIn(const Wall& wall) {
  if (const auto* const box = std::get_if<BoxWalls>(&wall.shape)) return 6 - box->open.size();
  return std::holds_alternative<SurfaceFile>(wall.shape) ? 0 : 1;
}

}  // namespace

std::vector<dem::PrimitiveWall> wallOfState(const Wall& wall, const dem::Model& grains) {
  const std::string& file = wall.state->file;
  if (wall.name.empty()) throw InputError("a wall of a state has no name", file, "give it the name that it has there");
  if (primitivesIn(wall) == 0)
    throw InputError("the place of a mesh is not read from states", file, "give it by \"shift\"");
  const Checkpoint checkpoint = loadCheckpoint(file);
  const Scene there = sceneOf(checkpoint, file);
  const auto found = std::ranges::find(there.walls, wall.name, &Wall::name);
  if (found == there.walls.end()) {
    std::vector<std::string> names;
    for (const Wall& one : there.walls)
      if (!one.name.empty()) names.push_back(one.name);
    throw InputError("the state has no wall \"" + wall.name + "\"", file,
                     names.empty() ? "name the wall in the scene of that run" : adviceFor(wall.name, names));
  }
  if (found->shape.index() != wall.shape.index() || openSides(*found) != openSides(wall))
    throw InputError("the wall \"" + wall.name + "\" has another shape in the state", file,
                     "give it the shape that it has there");
  std::size_t skipped = 0;
  for (auto before = there.walls.begin(); before != found; ++before) skipped += primitivesIn(*before);
  std::vector<dem::PrimitiveWall> primitives;
  for (const dem::TermOfState& term : dem::partsOf(coupling::particlesOf(checkpoint.state), file, grains).terms) {
    if (term.name != "walls" || primitives.size() == primitivesIn(wall)) continue;
    if (skipped > 0) {
      --skipped;
      continue;
    }
    ByteReader reader(term.bytes);
    dem::PrimitiveWallTerm saved{dem::PrimitiveWall{}};
    saved.load(reader);
    primitives.push_back(std::move(saved.wall));
  }
  if (primitives.size() != primitivesIn(wall))
    throw InputError("the state has fewer walls than its scene", file, "read a file that this version has written");
  return primitives;
}

void takeContacts(Built& built, const Scene& scene) {
  const auto* const from =
      scene.particles.empty() ? nullptr : std::get_if<GrainsOfState>(&scene.particles.front().from);
  if (!from) return;
  dem::Model& grains = built.run->grains;
  const Checkpoint checkpoint = loadCheckpoint(from->file);
  const dem::PartsOfState parts = dem::partsOf(coupling::particlesOf(checkpoint.state), from->file, grains);
  if (!beginWith(grains.particles.id, parts.ids))
    return note(built, "Some grains of the state were left out: contacts of the others with walls and solids");
  if (const int walls = dem::takeWallContacts(grains, parts.terms); walls > 0)
    note(built,
         "The state lacks " + std::to_string(walls) + " of the scene's walls at the same place: contacts with these");
  const Scene there = sceneOf(checkpoint, from->file);
  for (const std::string& name : takeSurfaceContacts(built, scene, there, from->file, parts.terms))
    note(built, "Contacts of \"" + name + "\", which is not in the state,");
}

}  // namespace dovetail::scene
