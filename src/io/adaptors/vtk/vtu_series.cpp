#include "dovetail/io_vtk/vtu_series.hpp"

#include <cmath>
#include <set>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/names.hpp"
#include "dovetail/io/output_folder.hpp"
#include "vtu_text.hpp"

namespace dovetail::io {

namespace {

/// Checks that every field has its own usable name and the right number of values.
class FieldCheck {
public:
  FieldCheck(const char* item, std::size_t count) : item_(item), count_(count) {}

  void operator()(const std::string& name, std::size_t size) {
    requirePlainName(name, std::string("fields per ") + item_);
    if (!seen_.insert(name).second)
      throw InputError("the field '" + name + "' occurs twice", std::string("fields per ") + item_,
                       "give each field its own name");
    if (size != count_)
      throw InputError("the field '" + name + "' has " + std::to_string(size) + " values",
                       std::string("fields per ") + item_, "give " + std::to_string(count_) + ", one per " + item_);
  }

  template <class Field>
  void all(const std::vector<Field>& fields) {
    for (const Field& field : fields) (*this)(field.name, field.values.size());
  }

private:
  const char* item_;
  std::size_t count_;
  std::set<std::string> seen_;
};

template <std::size_t n>
void requirePoints(std::span<const std::array<int, n>> cells, std::size_t points, const char* item) {
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    for (const int node : cells[cell])
      if (node < 0 || static_cast<std::size_t>(node) >= points)
        throw InputError(std::string(item) + " " + std::to_string(cell) + " names point " + std::to_string(node),
                         "frame", "use 0 to " + std::to_string(points) + " (excluded)");
}

void requireConsistent(const HexFrame& frame) {
  requirePoints(frame.cells, frame.points.size(), "cell");
  FieldCheck perPoint("point", frame.points.size());
  perPoint.all(frame.pointVectors);
  perPoint.all(frame.pointScalars);
  FieldCheck("cell", frame.cells.size()).all(frame.cellScalars);
}

void requireConsistent(const ParticleFrame& frame) {
  const std::size_t count = frame.position.size();
  FieldCheck perParticle("particle", count);
  perParticle("radius", frame.radius.size());
  perParticle("velocity", frame.velocity.empty() ? count : frame.velocity.size());
  perParticle("force", frame.force.empty() ? count : frame.force.size());
  perParticle("id", frame.id.empty() ? count : frame.id.size());
  perParticle.all(frame.vectors);
  perParticle.all(frame.scalars);
}

void requireConsistent(const PolyFrame& frame) {
  if (!frame.lines.empty() && !frame.triangles.empty())
    throw InputError("a frame has lines and triangles", "frame", "write them as two series");
  requirePoints(frame.lines, frame.points.size(), "line");
  requirePoints(frame.triangles, frame.points.size(), "triangle");
  FieldCheck perCell("cell", frame.lines.size() + frame.triangles.size());
  perCell.all(frame.vectors);
  perCell.all(frame.scalars);
  perCell.all(frame.integers);
}

void requireConsistent(const PointFrame& frame) {
  const std::size_t count = frame.points.size();
  FieldCheck perPoint("point", count);
  for (const ComponentField& field : frame.fields) {
    const auto components = static_cast<std::size_t>(field.components);
    perPoint(field.name, field.values.size() == count * components ? count : field.values.size());
  }
  perPoint.all(frame.integers);
}

}  // namespace

VtuSeries::VtuSeries(const std::filesystem::path& folder, std::string name, KeyValues provenance)
    : VtuSeries(folder, std::move(name), std::move(provenance), {}) {}

VtuSeries::VtuSeries(const std::filesystem::path& folder, std::string name, KeyValues provenance,
                     std::vector<double> times, FrameFile file)
    : folder_(folder), name_(std::move(name)), provenance_(withMark(std::move(provenance))), file_(file) {
  requirePlainName(name_, "VTU series");
  prepareOutputFolder(folder_, {name_ + ".pvd"});
  prepareInnerFolder(folder_ / name_);
  if (writesFiles()) requireFreeFrames();
  for (std::size_t frame = 0; frame < times.size(); ++frame)
    if (!isOurs(framePath(frame)))
      throw InputError("a frame of the run that is to go on is missing", framePath(frame).string(),
                       "restore it, or start a new run");
  times_ = std::move(times);
}

void VtuSeries::requireFreeFrames() const {
  const std::string ending = framePath(0).extension().string();
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / name_)) {
    const std::string found = entry.path().filename().string();
    if (found.starts_with(name_ + "_") && entry.path().extension() == ending) requireFreeOrOurs(entry.path());
  }
}

std::string VtuSeries::fileName(std::size_t frame) const {
  const std::string number = std::to_string(frame);
  return name_ + "_" + std::string(number.size() < 6 ? 6 - number.size() : 0, '0') + number +
         (file_ == FrameFile::vtu ? ".vtu" : ".vtp");
}

std::filesystem::path VtuSeries::framePath(std::size_t frame) const { return folder_ / name_ / fileName(frame); }

void VtuSeries::write(double time, const HexFrame& frame) {
  requireLater(time);
  requireConsistent(frame);
  commit(time, vtuText(time, frame, provenance_));
}

void VtuSeries::write(double time, const ParticleFrame& frame) {
  requireLater(time);
  requireConsistent(frame);
  commit(time, vtuText(time, frame, provenance_));
}

void VtuSeries::write(double time, const PolyFrame& frame) {
  requireLater(time);
  requireConsistent(frame);
  commit(time, vtpText(time, frame, provenance_));
}

void VtuSeries::write(double time, const PointFrame& frame) {
  requireLater(time);
  requireConsistent(frame);
  commit(time, vtuText(time, frame, provenance_));
}

void VtuSeries::write(double time, const std::string& vtu) {
  requireLater(time);
  commit(time, vtu);
}

void VtuSeries::requireLater(double time) const {
  if (!std::isfinite(time) || (!times_.empty() && time <= times_.back()))
    throw InputError("a frame's time is " + formatNumber(time) + " s", pvdPath().string(),
                     times_.empty() ? "give a finite time"
                                    : "give one after " + formatNumber(times_.back()) + " s, the last frame's");
}

void VtuSeries::commit(double time, const std::string& vtu) {
  if (times_.empty()) {
    removeFrames(folder_ / name_, name_);
    prepareInnerFolder(folder_ / name_);
  }
  writeFileAtomically(framePath(frames()), vtu, Survives::kills);
  std::string text = "<?xml version=\"1.0\"?>\n<!-- dovetail " + buildInfo().version +
                     " -->\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  std::vector<double> times = times_;
  times.push_back(time);
  for (std::size_t i = 0; i < times.size(); ++i)
    text += "    <DataSet timestep=\"" + formatNumber(times[i]) + "\" group=\"\" part=\"0\" file=\"" + name_ + "/" +
            fileName(i) + "\"/>\n";
  writeFileAtomically(pvdPath(), text + "  </Collection>\n</VTKFile>\n", Survives::kills);
  times_ = std::move(times);
}

}  // namespace dovetail::io
