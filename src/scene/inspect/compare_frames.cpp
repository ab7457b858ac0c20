// Frames of two runs side by side.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "comparing.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io_vtk/frame_reader.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;
using io::FrameArray;
using io::FrameContent;

/// What a point or cell is called: ids of a grain or of the two grains of a contact, and which of those of the same
/// name it is; without ids its number.
using Name = std::tuple<double, double, int>;

std::vector<Name> namesOf(const FrameContent& frame, bool perCell) {
  const FrameArray* const id = perCell ? frame.find("first", true) : frame.find("id", false);
  const FrameArray* const second = perCell ? frame.find("second", true) : nullptr;
  const std::size_t count = perCell ? frame.cells : frame.position.size();
  std::vector<Name> names;
  std::map<std::pair<double, double>, int> met;
  for (std::size_t k = 0; k < count; ++k) {
    const std::pair<double, double> pair{id ? id->values[k] : static_cast<double>(k), second ? second->values[k] : 0.0};
    names.emplace_back(pair.first, pair.second, met[pair]++);
  }
  return names;
}

/// Pairs of numbers of those that both have.
std::vector<std::pair<std::size_t, std::size_t>> matched(const std::vector<Name>& a, const std::vector<Name>& b) {
  std::map<Name, std::size_t> place;
  for (std::size_t k = 0; k < b.size(); ++k) place[b[k]] = k;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (const auto found = place.find(a[k]); found != place.end()) pairs.emplace_back(k, found->second);
  return pairs;
}

double extentOf(const FrameContent& frame) {
  if (frame.position.empty()) return 0.0;
  Vec3 least = frame.position[0], most = least;
  for (const Vec3& x : frame.position)
    for (int c = 0; c < 3; ++c) least[c] = std::min(least[c], x[c]), most[c] = std::max(most[c], x[c]);
  return norm(most - least);
}

/// The quantities of a series of frames, over all of them.
class FramesComparison {
public:
  FramesComparison(std::string name, Comparison& to) : name_(std::move(name)), to_(to) {}
  ~FramesComparison() {
    for (auto& [what, difference] : found_) to_.differences.push_back(std::move(difference));
    for (const auto& [what, one] : unlike_)
      to_.unlike.push_back(name_ + ", " + one.first + ": " + one.text +
                           (one.frames > 1 ? " Likewise in " + std::to_string(one.frames - 1) + " more frames." : ""));
  }
  FramesComparison(const FramesComparison&) = delete;
  FramesComparison& operator=(const FramesComparison&) = delete;

  void add(const FrameContent& a, const FrameContent& b, const std::string& when) {
    for (const bool perCell : {false, true}) {
      const std::vector<Name> first = namesOf(a, perCell), second = namesOf(b, perCell);
      const auto pairs = matched(first, second);
      if (pairs.size() != first.size() || pairs.size() != second.size())
        note(perCell ? "cells" : "points", when,
             std::to_string(first.size()) + " and " + std::to_string(second.size()) + (perCell ? " cells" : " points") +
                 ", of which " + std::to_string(pairs.size()) + " are in both.");
      if (!perCell && !a.find("first", true)) comparePositions(a, b, pairs, when);
      for (const FrameArray& array : a.arrays)
        if (array.perCell == perCell) compareArray(array, b.find(array.name, perCell), pairs, when);
    }
    for (const FrameArray& array : b.arrays)
      if (!a.find(array.name, array.perCell)) miss(array.name, "second", when);
  }

private:
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

  /// One line for all frames: what was met first, and in how many.
  void note(const std::string& what, const std::string& when, const std::string& text) {
    Unlike& one = unlike_.try_emplace(what, Unlike{when, text, 0}).first->second;
    ++one.frames;
  }
  void miss(const std::string& array, const char* owner, const std::string& when) {
    note(array, when, array + " is in the " + owner + " only.");
  }
  Difference& quantity(const std::string& what) {
    Difference& difference = found_[what];
    difference.what = name_ + " " + what;
    return difference;
  }
  static void take(Difference& difference, double value, std::size_t item, const std::string& when) {
    if (!(value > difference.largest)) return;
    difference.largest = value;
    difference.where = when + ", number " + std::to_string(item);
  }
  void comparePositions(const FrameContent& a, const FrameContent& b, const Pairs& pairs, const std::string& when) {
    Difference& difference = quantity("position");
    difference.scale = std::max({difference.scale, extentOf(a), extentOf(b)});
    for (const auto& [i, j] : pairs)
      for (int c = 0; c < 3; ++c) take(difference, apart(a.position[i][c], b.position[j][c]), i, when);
  }
  void compareArray(const FrameArray& a, const FrameArray* b, const Pairs& pairs, const std::string& when) {
    if (!b || b->components != a.components) return miss(a.name, "first", when);
    Difference& difference = quantity(a.name);
    for (const FrameArray* const array : {&a, b})
      for (const double value : array->values)
        if (std::isfinite(value)) difference.scale = std::max(difference.scale, std::abs(value));
    const auto n = static_cast<std::size_t>(a.components);
    for (const auto& [i, j] : pairs)
      for (std::size_t c = 0; c < n; ++c) take(difference, apart(a.values[n * i + c], b->values[n * j + c]), i, when);
  }

  std::string name_;
  Comparison& to_;
  std::map<std::string, Difference> found_;
  struct Unlike {
    std::string first, text;
    std::size_t frames;
  };
  std::map<std::string, Unlike> unlike_;
};

}  // namespace

bool isFrameFile(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".pvd" || ending == ".vtu" || ending == ".vtp" || ending == ".vti";
}

void compareFrames(const fs::path& a, const fs::path& b, const std::string& name, Comparison& to) {
  FramesComparison comparison(name, to);
  if (a.extension() != ".pvd") return comparison.add(io::readFrame(a), io::readFrame(b), "frame");
  const auto first = io::readPvd(a), second = io::readPvd(b);
  std::map<double, fs::path> others;
  for (const auto& [time, file] : second) others[time] = file;
  std::size_t common = 0;
  for (const auto& [time, file] : first) {
    const double reach = 1e-9 * std::abs(time);
    const auto found = others.lower_bound(time - reach);
    if (found == others.end() || found->first > time + reach) continue;
    ++common;
    comparison.add(io::readFrame(file), io::readFrame(found->second), "t = " + formatNumber(time) + " s");
  }
  if (common != first.size() || common != second.size())
    to.unlike.push_back(name + " has " + std::to_string(first.size()) + " and " + std::to_string(second.size()) +
                        " frames, " + std::to_string(common) + " of them at the same times.");
}

}  // namespace dovetail::scene
