// What stages of a scene change at their start.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// What the changes of a stage depend on beside the scene; states hold it, so that a run that goes on makes them alike.
struct StageStart {
  double time = 0.0;            ///< s
  std::vector<double> travels;  ///< m or rad, of the servo of each wall, 0 without
  struct Displacements {
    std::vector<Vec3> u;  ///< m
  };
  std::vector<Displacements> displacements;  ///< of the nodes of each solid whose supports change, else none
};
template <class Archive, class D>
void archiveFields(Archive& archive, D& of) requires std::is_same_v<std::remove_const_t<D>, StageStart::Displacements> {
  archive(of.u);
}
template <class Archive, class S>
void archiveFields(Archive& archive, S& start) requires std::is_same_v<std::remove_const_t<S>, StageStart> {
  archive(start.time, start.travels, start.displacements);
}

/// Now, of a started run before this stage.
StageStart startOf(const Built& built, const Scene& scene, std::size_t stage);
/// Whether grains are where they are as the stage begins, or a state will put them there.
enum class Grains { areThere, follow };
/// Makes the changes of a stage.
/// @throws InputError with the place of what cannot be, such as grains behind walls that are put in place
void beginStage(Built& built, const Scene& scene, std::size_t stage, const StageStart& start, Grains grains);
/// @throws InputError with the place of changes of what is not there, of laws that cannot change, or of walls that are
/// to move steadily while a stage relaxes
void requireChanges(const Built& built, const Scene& scene);

/// A copy of the grains as they are now with the changes of all stages up to this one: walls move as at its start.
dem::Model grainsAt(const Built& built, const Scene& scene, std::size_t stage);
/// With the laws of contacts that hold from this stage on.
Scene lawsAt(const Scene& scene, std::size_t stage);
bool changesLaws(const Stage& stage);
/// Whether a stage changes gravity.
bool changesGravity(const Scene& scene);
/// Whether a stage changes supports of a solid.
bool changesSupports(const Solid& solid, const Scene& scene);
/// Whether a stage changes a load of a solid.
bool isChanged(const Load& load, const Solid& solid, const Scene& scene);
/// Whether a stage changes the motion of a plane of a solid.
bool isPlaneChanged(const std::string& solid, std::size_t plane, const Scene& scene);
std::string keyOfPlane(const std::string& solid, std::size_t plane);
std::string keyOfLoad(const std::string& solid, const Load& load, int component);

}  // namespace dovetail::scene
