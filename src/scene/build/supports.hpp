// Who holds, moves and carries which component of the nodes of a solid.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/fem/model/model.hpp"
#include "dovetail/scene/build.hpp"
#include "time_functions.hpp"

namespace dovetail::scene {

/// Puts supports and ties on a model, one after the other, supports first. What is held or moved twice to the same
/// place is so once; a tie leaves alone what its masters' supports and a support of its node do anyway.
class Holders {
public:
  /// @param step  of the run
  Holders(fem::Model& model, const fem::SolidMesh& mesh, const Solid& solid, const Scene& scene, StepOf step);

  /// @throws InputError naming the node and both, if another support moves it otherwise
  void hold(const SupportNow& support);
  /// @throws InputError naming the node, if a support or another tie asks otherwise
  void carry(const MeshTie& tie);
  /// What is moved away from where it lies at t = 0 at once: sentences with what to write instead.
  const std::vector<std::string>& jumps() const { return jumps_; }

private:
  struct Motion {
    std::string name;       ///< of the support
    bool steady = false;    ///< with `velocity`, from where it lies
    double velocity = 0.0;  ///< m/s
    TimeFunction displacement{};
    /// In its place, of the undeformed place and the displacement at the start, m, and the time.
    std::function<double(const Vec3&, const Vec3&, double)> field{};
    std::string text{};
    double since = 0.0;                       ///< s
    const std::vector<Vec3>* from = nullptr;  ///< displacements at its start, m; null: as the nodes are
  };
  static constexpr int nobody = -1;

  Motion motionOf(const SupportNow& held, int component) const;
  const Vec3& startOf(const Motion& motion, int node) const;
  double at(const Motion& motion, int node, double t) const;
  void claim(const std::vector<int>& set, int component, Motion motion);
  void prescribe(const std::vector<int>& nodes, int component, const Motion& motion);
  void lookForJump(const std::vector<int>& set, const Motion& motion, int component);
  bool areSame(int first, int second, int node);
  bool areAlike(const Motion& a, const Motion& b, int node) const;
  bool masterGoesAlong(const fem::Tie& tie, int motion);
  std::string placeOf(int node, int component) const;

  fem::Model& model_;
  const fem::SolidMesh& mesh_;
  const Solid& solid_;
  const Scene& scene_;
  StepOf step_;
  std::vector<Motion> motions_;
  std::vector<int> heldBy_;  ///< number of the motion, by 3 node + component
  std::vector<const MeshTie*> carriedBy_, masterOf_;
  std::map<std::pair<int, int>, bool> same_;
  std::vector<std::string> jumps_;
};

/// Puts supports and the ties of the solid on its model in place of all that it has.
/// @return what is moved at once, as Holders::jumps. @throws InputError with the place of one at fault
std::vector<std::string> putHolders(fem::Model& model, const fem::SolidMesh& mesh, const Solid& solid,
                                    const Scene& scene, const StepOf& step, const std::vector<SupportNow>& supports);
/// Those of the scene.
std::vector<SupportNow> supportsOf(const Solid& solid);

}  // namespace dovetail::scene
