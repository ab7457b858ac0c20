#include "dovetail/rve/frame.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "border.hpp"
#include "contacts/contact_list.hpp"
#include "contacts/sweep.hpp"
#include "contacts/touching.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/rve.hpp"
#include "freedom.hpp"
#include "motion/projection.hpp"

namespace dovetail::rve {

namespace {

constexpr const char* where = "framed cell";

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void check(const Rve& cell, const Conditions& conditions) {
  if (cell.shape != Shape::disc) throw InputError("the grains are spheres", where, "use a periodic cell for spheres");
  if (!cell.frame.empty()) throw InputError("the cell has a frame already", where, "give a periodic cell");
  if (!cell.state.contacts.bond.empty())
    throw InputError("the cell is bonded", where, "cut a cell that is not, and bond it then");
  const auto differ = [](Condition a, Condition b) { return (a == Condition::periodic) != (b == Condition::periodic); };
  for (Condition SideCondition::*part : {&SideCondition::along, &SideCondition::across})
    if (differ(conditions.left.*part, conditions.right.*part) || differ(conditions.bottom.*part, conditions.top.*part))
      throw InputError("a side is periodic and the opposite one is not", where, "make both periodic, or none");
}

/// All grains of the framed cell: the frame first.
std::vector<Placed> collect(const Border& border, Frame& frame) {
  std::vector<Placed> all;
  for (const std::vector<Placed>& side : border.side) all.insert(all.end(), side.begin(), side.end());
  frame.grain.resize(all.size());
  std::iota(frame.grain.begin(), frame.grain.end(), 0);
  all.insert(all.end(), border.inner.begin(), border.inner.end());
  for (const Placed& placed : all) {
    frame.original.push_back(placed.grain);
    frame.image.push_back(placed.image);
  }
  return all;
}

void joinAlike(Frame& frame, std::size_t grains) {
  std::vector<std::vector<int>> groups(grains);
  for (std::size_t q = 0; q < frame.grain.size(); ++q) groups[at(frame.original[q])].push_back(static_cast<int>(q));
  for (std::vector<int>& group : groups)
    if (!group.empty()) frame.alike.push_back(std::move(group));
}

/// Liu 2018, eq. 2.2.
void setAreas(Frame& frame, const std::vector<double>& radius, double thickness) {
  const std::size_t n = frame.grain.size();
  for (std::size_t q = 0; q < n; ++q) {
    const std::size_t before = (q + n - 1) % n, after = (q + 1) % n;
    const double r = radius[at(frame.grain[q])];
    const Vec3 edge = r / (r + radius[at(frame.grain[before])]) * (frame.place[q] - frame.place[before]) +
                      r / (r + radius[at(frame.grain[after])]) * (frame.place[after] - frame.place[q]);
    frame.area.push_back(thickness * Vec3{edge.y, -edge.x, 0.0});
  }
}

/// Springs take the stretch that they have where the cell repeats.
void inheritSprings(Rve& cell, const Rve& from) {
  Contacts& to = cell.state.contacts;
  const Contacts& old = from.state.contacts;
  forEachTouch(cell, [&](const Touch& touch) {
    std::size_t p = touch.i, q = touch.j;
    const bool turned = cell.frame.original[p] > cell.frame.original[q];
    if (turned) std::swap(p, q);
    int code = 0;
    for (std::size_t k = 3; k-- > 0;) code = 3 * code + cell.frame.image[q][k] - cell.frame.image[p][k] + 1;
    const std::size_t i = at(cell.frame.original[p]);
    for (int c = old.first[i]; c < old.first[i + 1]; ++c) {
      if (old.other[at(c)] != cell.frame.original[q] || old.image[at(c)] != code) continue;
      to.stretch[0][touch.contact] = old.stretch[0][at(c)];
      if (!to.roll.empty()) to.roll[touch.contact] = (turned ? -1.0 : 1.0) * old.roll[at(c)];
    }
  });
}

Rve cutAlong(const Rve& from, const Border& border, const Conditions& conditions) {
  Rve cell;
  Frame frame;
  const std::vector<Placed> all = collect(border, frame);
  joinAlike(frame, from.size());
  setFreedom(frame, border, conditions);
  Grains grains{.density = from.density};
  for (const Placed& placed : all) {
    grains.centre.push_back(centreOf(from, placed));
    grains.radius.push_back(from.radius[at(placed.grain)]);
  }
  for (const int q : frame.grain) frame.place.push_back(grains.centre[at(q)]);
  setAreas(frame, grains.radius, norm(from.state.lattice.period[2]));
  geometry::Lattice open = from.state.lattice;
  open.axes = {false, false, false};
  cell = makeRve(grains, open, from.springs);
  cell.skin = from.skin;
  cell.frame = std::move(frame);
  updateNeighbourList(cell);
  inheritSprings(cell, from);
  sweep(cell, 0.0);
  return cell;
}

}  // namespace

Rve framed(const Rve& cell, const Conditions& conditions) {
  check(cell, conditions);
  std::vector<int> order(cell.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return cell.radius[at(a)] > cell.radius[at(b)]; });
  const double contacts = balance(cell).coordination * static_cast<double>(cell.size());
  for (const int corner : order) {
    const std::optional<Border> border = borderThrough(cell, corner);
    if (!border) continue;
    Rve cut = cutAlong(cell, *border, conditions);
    // Each contact is there, in one place or several.
    if (std::abs(balance(cut).coordination * static_cast<double>(cell.size()) - contacts) < 1e-6) return cut;
  }
  throw InputError("no grain is suitable as a corner of a frame", where, "take more grains");
}

std::vector<Vec3> reactions(const Rve& cell) {
  Components force, torque;
  freeForces(cell, force, torque);
  std::vector<Vec3> found;
  for (const int g : cell.frame.grain) {
    const std::size_t i = at(g);
    found.push_back({force[0][i] - cell.state.force[0][i], force[1][i] - cell.state.force[1][i], 0.0});
  }
  return found;
}

Eigen::Matrix3d stressOfReactions(const Rve& cell) {
  const std::vector<Vec3> a = reactions(cell);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t q = 0; q < a.size(); ++q) {
    const std::size_t g = at(cell.frame.grain[q]);
    sum += Eigen::Vector3d(a[q].x, a[q].y, a[q].z) * Eigen::RowVector3d(cell.state.x[0][g], cell.state.x[1][g], 0.0);
  }
  const Eigen::Matrix3d& F = cell.state.F;
  const Eigen::Matrix3d kirchhoff = sum / cell.volume;
  return 0.5 * (kirchhoff + kirchhoff.transpose()) * F.inverse().transpose();
}

}  // namespace dovetail::rve
