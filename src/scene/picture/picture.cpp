#include "dovetail/scene/picture.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/nearest.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/picture/legend.hpp"
#include "dovetail/report/figure.hpp"
#include "dovetail/report/text.hpp"
#include "dovetail/scene/execute.hpp"
#include "quantities.hpp"
#include "run_frames.hpp"
#include "shown_fields.hpp"
#include "shown_walls.hpp"
#include "valid_options.hpp"
#include "view.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;
using picture::Colour;

Colour colourNamed(const std::string& name) {
  if (name == "white") return {255, 255, 255};
  if (name == "black") return {0, 0, 0};
  const bool isHex =
      name.size() == 7 && name[0] == '#' && name.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!isHex)
    throw InputError("'" + name + "' is no colour", "--background", "give white, black, or one such as #e8eef4");
  const auto channel = [&](std::size_t k) {
    return static_cast<std::uint8_t>(std::stoi(name.substr(k, 2), nullptr, 16));
  };
  return {channel(1), channel(3), channel(5)};
}

/// Discs, which are drawn as balls.
bool liesInPlane(const picture::Drawing& drawing) {
  return drawing.triangles.empty() && !drawing.balls.empty() &&
         std::ranges::all_of(drawing.balls, [](const picture::Ball& ball) { return ball.centre.z == 0.0; });
}

class Pictures {
public:
  Pictures(const fs::path& folder, const PictureOptions& options)
      : options_(options),
        scene_(readRun(folder)),
        frames_(folder, scene_, options.mode.has_value(), options.cell),
        background_(colourNamed(options.background)),
        fields_(options_, scene_, isDark(), someFrames()) {
    if (!options.cell.empty()) scene_.walls.clear();
    if (options.lines != "none" && !frames_.has(options.lines))
      throw InputError("there are no frames of " + options.lines, "--lines",
                       "add \"" + options.lines + "\" to \"contents\" in \"output\" of the scene, and run again");
  }

  std::size_t count() const { return frames_.count(); }
  std::size_t numberOf(int frame) const { return frames_.numberOf(frame); }

  /// Ranges of colours, camera and size for these frames.
  void prepare(const std::vector<std::size_t>& which) {
    for (const std::size_t k : which) fields_.spreadOver(frames_.read(k));
    fields_.endRanges();
    // First, middle and last frame are enough to see how far things go.
    std::vector<picture::Drawing> some;
    for (const std::size_t k : {which.front(), which[which.size() / 2], which.back()}) {
      some.push_back(fields_.drawingOf(frames_.read(k), cut_, sizeOfBox()));
      const geometry::Box box = boxOf(some.back());
      box_ = some.size() == 1 ? box
                              : geometry::Box{{std::min(box_.lower.x, box.lower.x), std::min(box_.lower.y, box.lower.y),
                                               std::min(box_.lower.z, box.lower.z)},
                                              {std::max(box_.upper.x, box.upper.x), std::max(box_.upper.y, box.upper.y),
                                               std::max(box_.upper.z, box.upper.z)}};
    }
    const Vec3 up = norm(scene_.gravity) > 0.0 ? -scene_.gravity : Vec3{0, 0, 1};
    geometry::Box seen = box_;
    if (liesInPlane(some.back())) seen.lower.z = seen.upper.z = 0.0;
    camera_ = viewOf(seen, up, options_.azimuth, options_.elevation);
    if (isSeenFromItsEdge(box_, camera_))
      throw InputError("all lies in a plane that is seen from its edge", "--azimuth, --elevation",
                       "give others, or leave both out to look across the plane");
    chooseCut();
    placeCamera(some, frames_.read(which.back()));
  }

  picture::Image draw(std::size_t number, int samples) {
    const Instant instant = frames_.read(number);
    picture::Drawing drawing = fields_.drawingOf(instant, cut_, sizeOfBox());
    addWalls(drawing, instant);
    hideFineLines(drawing);
    const picture::Look look{background_, samples, 2.2 * ShownFields::meanRadius(drawing, sizeOfBox()), 0.45};
    picture::Camera camera = camera_;
    const picture::Legend legend = legendOf(instant.time);
    picture::Image image = picture::draw(drawing, camera, options_.width, height_, look);
    picture::write(image, legend, camera);
    return image;
  }

  std::string caption(std::size_t number) {
    const double time = frames_.read(number).time;
    return timeText(time) + fields_.caption() +
           (cut_ ? report::format("; section at %c = %.4g m", "xyz"[cut_->axis], cut_ -> at) : "") +
           (options_.warp != 1.0 ? report::format("; displacements × %.4g", options_.warp) : "");
  }

private:
  bool isDark() const { return background_.red + background_.green + background_.blue < 380; }
  double sizeOfBox() const { return norm(box_.upper - box_.lower); }
  /// Grains may come and go.
  std::vector<Instant> someFrames() const {
    const std::size_t last = frames_.count() - 1;
    return {frames_.read(last), frames_.read(last / 2), frames_.read(0)};
  }

  void addWalls(picture::Drawing& drawing, const Instant& instant) const {
    const Vec3 size = box_.upper - box_.lower;
    const double margin = 0.04 * std::max({size.x, size.y, size.z});
    for (const picture::Triangle& triangle : behind(
             wallsOf(scene_, instant, geometry::expanded(box_, margin), camera_.back, {ofWalls, ofClearWalls}), cut_))
      drawing.triangles.push_back(triangle);
  }

  /// Lines of elements are left out where they would cover the faces.
  void hideFineLines(picture::Drawing& drawing) const {
    double length = 0.0, count = 0.0;
    for (const picture::Triangle& t : drawing.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if ((t.edges >> k & 1) != 0) length += norm(t.corner[(k + 1) % 3] - t.corner[k]), count += 1.0;
    if (count > 0.0 && length / count >= 7.0 * camera_.metresPerPixel) return;
    for (picture::Triangle& triangle : drawing.triangles) triangle.edges = 0;
  }

  void chooseCut() {
    const bool overlaps = std::any_of(scene_.couplings.begin(), scene_.couplings.end(),
                                      [](const Coupling& c) { return std::holds_alternative<Overlap>(c.kind); });
    if (options_.cutAxis == "none" || (options_.cutAxis.empty() && !overlaps)) return;
    int axis = 0;
    for (int c = 1; c < 3; ++c)
      if (std::abs(camera_.back[c]) > std::abs(camera_.back[axis])) axis = c;
    if (!options_.cutAxis.empty()) axis = options_.cutAxis[0] - 'x';
    // Not in the very middle, where many meshes have a plane of nodes, which shows none of its elements.
    const double fraction = camera_.back[axis] < 0.0 ? 0.53 : 0.47;
    const double middle = box_.lower[axis] + fraction * (box_.upper[axis] - box_.lower[axis]);
    constexpr double aPixel = 1e-3;  // of the picture
    cut_ = Cut{axis, options_.cutAxis.empty() ? middle : options_.cutAt, camera_.back[axis] < 0.0 ? -1.0 : 1.0,
               aPixel * sizeOfBox()};
  }

  /// So that all that is drawn fills the room that the legend leaves.
  void placeCamera(const std::vector<picture::Drawing>& drawings, const Instant& instant) {
    Extent extent;
    picture::Drawing withWalls = drawings.back();
    addWalls(withWalls, instant);
    const geometry::Box walls = geometry::expanded(box_, 0.35 * norm(box_.upper - box_.lower));
    const auto add = [&](const Vec3& x, double radius) {
      for (int c = 0; c < 3; ++c)
        if (x[c] < walls.lower[c] || x[c] > walls.upper[c]) return;
      extent.add(camera_, x, radius);
    };
    for (const picture::Drawing& drawing : drawings)
      for (const picture::Ball& ball : drawing.balls) add(ball.centre, ball.radius);
    for (std::size_t d = 0; d <= drawings.size(); ++d)
      for (const picture::Triangle& triangle : (d < drawings.size() ? drawings[d] : withWalls).triangles)
        for (const Vec3& corner : triangle.corner) add(corner, 0.0);
    for (const picture::Rod& rod : drawings.back().rods) add(rod.from, rod.radius), add(rod.to, rod.radius);
    if (extent.left > extent.right) extent = {-1.0, 1.0, -1.0, 1.0};
    const double wide = std::max(1e-12, extent.right - extent.left),
                 high = std::max(1e-12, extent.above - extent.below);
    const int width = options_.width;
    height_ = options_.height;
    for (int pass = 0; options_.height == 0 && pass < 3; ++pass) {
      // The legend's room depends on the height.
      const auto [top, bottom] = picture::roomOf(legendOf(0.0), width, std::max(height_, width / 2));
      height_ = std::clamp(static_cast<int>(0.94 * width * high / wide) + top + bottom, width * 2 / 5, width);
    }
    const auto [top, bottom] = picture::roomOf(legendOf(0.0), width, height_);
    if (height_ - top - bottom < 20)
      throw InputError("the picture is too small for its legend", "--size", "give at least 200 x 150 pixels");
    camera_.metresPerPixel = std::max(wide / (0.94 * width), high / (0.96 * (height_ - top - bottom)));
    camera_.centre +=
        0.5 * (extent.left + extent.right) * camera_.right + 0.5 * (extent.below + extent.above) * camera_.up;
    camera_.centre += 0.5 * (top - bottom) * camera_.metresPerPixel * camera_.up;
  }

  std::string timeText(double time) const {
    if (options_.mode) return report::format("mode %.0f", time);
    const double shown = std::abs(time) < 1e-9 ? 0.0 : time;  // frames of one instant are 1e-12 s apart
    const auto [factor, unit] = prefixed(shown, "s");
    return report::format("t = %.4g ", shown * factor) + unit;
  }

  picture::Legend legendOf(double time) const {
    picture::Legend legend;
    legend.time = timeText(time);
    if (cut_) legend.time += report::format(",  section at %c = %.3g m", "xyz"[cut_->axis], cut_ -> at);
    if (options_.warp != 1.0) legend.time += report::format(",  displacements × %.4g", options_.warp);
    if (isDark()) legend.ink = {225, 225, 225};
    legend.bars = fields_.bars();
    const double target = 0.14 * options_.width * camera_.metresPerPixel,
                 unit = std::pow(10.0, std::floor(std::log10(target)));
    const double length = target >= 5.0 * unit ? 5.0 * unit : target >= 2.0 * unit ? 2.0 * unit : unit;
    const auto [factor, name] = prefixed(length, "m");
    legend.length = report::format("%.4g ", length * factor) + name;
    legend.pixels = length / camera_.metresPerPixel;
    return legend;
  }

  PictureOptions options_;
  Scene scene_;
  RunFrames frames_;
  Colour background_;
  ShownFields fields_;
  geometry::Box box_;
  std::optional<Cut> cut_;
  picture::Camera camera_;
  int height_ = 0;
};

std::string programMark() { return "dovetail " + io::buildInfo().version + " " + io::buildInfo().commit; }

}  // namespace

Picture drawPicture(const fs::path& folder, const PictureOptions& options) {
  requireValid(options);
  Pictures pictures(folder, options);
  std::vector<std::size_t> which;
  if (options.mode && (*options.mode < 1 || *options.mode > static_cast<int>(pictures.count())))
    throw InputError("there is no mode " + std::to_string(*options.mode), "--mode",
                     "give a number from 1 to " + std::to_string(pictures.count()));
  if (!options.film) which.push_back(pictures.numberOf(options.mode ? *options.mode - 1 : options.frame));
  for (std::size_t k = 0; options.film && k < pictures.count(); ++k) which.push_back(k);
  pictures.prepare(which);
  if (!options.film) {
    const std::string caption = pictures.caption(which[0]);
    return {picture::pngOf(pictures.draw(which[0], 3), programMark(), caption), caption};
  }
  std::vector<picture::Image> images;
  for (const std::size_t k : which) images.push_back(pictures.draw(k, 2));
  const double seconds = std::clamp(8.0 / static_cast<double>(images.size()), 0.03, 0.25);
  return {picture::gifOf(images, seconds, programMark()), std::to_string(images.size()) + " frames"};
}

fs::path writePicture(const fs::path& folder, const PictureOptions& options, std::ostream& log) {
  const char* const ending = options.film ? ".gif" : ".png";
  fs::path file = options.file.empty() ? folder / (options.film ? "film.gif" : "picture.png") : options.file;
  if (file.extension() != ending)
    throw InputError(options.film ? "films are GIF files" : "pictures are PNG files", file.string(),
                     std::string("give a name that ends in ") + ending);
  io::requireFreeOrOurs(file);
  const Picture picture = drawPicture(folder, options);
  io::writeFileAtomically(file, picture.bytes);
  log << picture.caption << ": " << file.string() << '\n';
  return file;
}

ShownRun showRun(const fs::path& folder) {
  std::error_code error;
  bool hasFrames = false;
  for (const auto& entry : fs::directory_iterator(folder, error))
    hasFrames = hasFrames || entry.path().extension() == ".pvd";
  if (!hasFrames) return {};
  try {
    Pictures pictures(folder, {});
    const std::size_t last = pictures.numberOf(-1);
    pictures.prepare({last});
    const std::string caption = pictures.caption(last);
    return {picture::pngOf(pictures.draw(last, 3), programMark(), caption), caption};
  } catch (const InputError& wrong) {
    return {"", wrong.what()};
  }
}

}  // namespace dovetail::scene
