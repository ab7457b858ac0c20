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
#include "shown_walls.hpp"
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

/// Numbers of the drawing's paints.
enum Paints : std::uint8_t { ofGrains, ofSolids, ofLines, ofWalls, ofClearWalls, plainSolid, plainGrain };

/// A field with the ends of its colours.
struct Coloured {
  Hue hue;
  picture::Palette palette = picture::Palette::cold;
  Spread spread{};
  ColourRange range{};
  float place(double value) const { return static_cast<float>((value - range.low) / (range.high - range.low)); }
};

class Pictures {
public:
  Pictures(const fs::path& folder, const PictureOptions& options)
      : options_(options),
        scene_(readRun(folder)),
        frames_(folder, scene_),
        background_(colourNamed(options.background)) {
    // Grains may come and go.
    const std::size_t last = frames_.count() - 1;
    chooseFields({frames_.read(last), frames_.read(last / 2), frames_.read(0)});
    if (options.lines != "none" && !frames_.has(options.lines))
      throw InputError("there are no frames of " + options.lines, "--lines",
                       "add \"" + options.lines + "\" to \"contents\" in \"output\" of the scene, and run again");
  }

  std::size_t count() const { return frames_.count(); }
  std::size_t numberOf(int frame) const { return frames_.numberOf(frame); }

  /// Ranges of colours, camera and size for these frames.
  void prepare(const std::vector<std::size_t>& which) {
    for (const std::size_t k : which) spreadOver(frames_.read(k));
    for (Coloured* const field : {&grains_, &solids_, &lines_}) field->range = field->spread.range(field->hue.signs);
    if (sharesQuantity())
      grains_.range = solids_.range = {std::min(grains_.range.low, solids_.range.low),
                                       std::max(grains_.range.high, solids_.range.high)};
    if (options_.grainRange) grains_.range = *options_.grainRange;
    if (options_.solidRange) solids_.range = *options_.solidRange;
    for (Coloured* const field : {&grains_, &solids_, &lines_})
      if (field->hue.signs && field->range.low < 0.0 && field->range.high > 0.0)
        field->palette = picture::Palette::signs;
    // First, middle and last frame are enough to see how far things go.
    std::vector<picture::Drawing> some;
    for (const std::size_t k : {which.front(), which[which.size() / 2], which.back()}) {
      some.push_back(drawingOf(frames_.read(k)));
      const geometry::Box box = boxOf(some.back());
      box_ = some.size() == 1 ? box
                              : geometry::Box{{std::min(box_.lower.x, box.lower.x), std::min(box_.lower.y, box.lower.y),
                                               std::min(box_.lower.z, box.lower.z)},
                                              {std::max(box_.upper.x, box.upper.x), std::max(box_.upper.y, box.upper.y),
                                               std::max(box_.upper.z, box.upper.z)}};
    }
    const Vec3 up = norm(scene_.gravity) > 0.0 ? -scene_.gravity : Vec3{0, 0, 1};
    camera_ = viewOf(box_, up, options_.azimuth, options_.elevation);
    chooseCut();
    placeCamera(some, frames_.read(which.back()));
  }

  picture::Image draw(std::size_t number, int samples) {
    const Instant instant = frames_.read(number);
    picture::Drawing drawing = drawingOf(instant);
    addWalls(drawing, instant);
    hideFineLines(drawing);
    const picture::Look look{background_, samples, 2.2 * meanRadius(drawing), 0.45};
    picture::Camera camera = camera_;
    const picture::Legend legend = legendOf(instant.time);
    picture::Image image = picture::draw(drawing, camera, options_.width, height_, look);
    picture::write(image, legend, camera);
    return image;
  }

  std::string caption(std::size_t number) {
    const double time = frames_.read(number).time;
    return timeText(time) + (grains_.hue.name.empty() ? "" : "; grains: " + grains_.hue.title) +
           (solids_.hue.name.empty() ? "" : "; solids: " + solids_.hue.title) +
           (cut_ ? report::format("; section at %c = %.4g m", "xyz"[cut_->axis], cut_ -> at) : "") +
           (options_.warp != 1.0 ? report::format("; displacements × %.4g", options_.warp) : "");
  }

private:
  bool isDark() const { return background_.red + background_.green + background_.blue < 380; }

  static std::string choose(const std::string& wanted, const std::vector<std::string>& there,
                            std::initializer_list<const char*> order, const std::string& option) {
    const auto has = [&](const std::string& name) {
      return std::find(there.begin(), there.end(), name) != there.end();
    };
    if (wanted == "none") return "";
    if (!wanted.empty() && !has(wanted))
      throw InputError(
          "frames have no field '" + wanted + "'", option,
          adviceFor(wanted, there) + ", or add it to \"contents\" in \"output\" of the scene, and run again");
    if (!wanted.empty()) return wanted;
    for (const char* const name : order)
      if (has(name)) return name;
    return "";
  }

  void chooseFields(const std::vector<Instant>& instants) {
    std::vector<std::string> ofSolidFrames, ofGrainFrames;
    const auto add = [](std::vector<std::string>& to, const io::FrameContent* frame) {
      if (!frame || frame->position.empty()) return;
      for (const std::string& name : fieldsOf(*frame))
        if (std::find(to.begin(), to.end(), name) == to.end()) to.push_back(name);
    };
    for (const Instant& instant : instants) {
      add(ofGrainFrames, instant.find("grains"));
      for (const Solid& solid : scene_.solids) add(ofSolidFrames, instant.find("solid_" + solid.name));
    }
    grains_ = {quantityNamed(choose(options_.grains, ofGrainFrames, {"speed", "radius"}, "--grains")),
               picture::Palette::cold};
    solids_ = {quantityNamed(choose(options_.solids, ofSolidFrames, {"von_mises", "displacement"}, "--solids")),
               picture::Palette::warm};
    lines_ = {quantityNamed("normal_force"), picture::Palette::warm};
    lines_.hue.signs = options_.lines == "bonds";
  }

  std::vector<double> ofSolid(const io::FrameContent& frame) const {
    if (solids_.hue.name.empty()) return {};
    std::vector<double> values = valuesAt(frame, solids_.hue.name, false);
    if (!values.empty()) return values;
    values = valuesAt(frame, solids_.hue.name, true);
    return values.empty() ? values : atPoints(frame, values);
  }

  void spreadOver(const Instant& instant) {
    if (const io::FrameContent* const grains = instant.find("grains"); grains && !grains_.hue.name.empty())
      grains_.spread.add(valuesAt(*grains, grains_.hue.name, false));
    for (const Solid& solid : scene_.solids)
      if (const io::FrameContent* const frame = instant.find("solid_" + solid.name))
        solids_.spread.add(ofSolid(*frame));
    if (const io::FrameContent* const lines = instant.find(options_.lines))
      lines_.spread.add(valuesAt(*lines, "normal_force", true));
  }

  picture::Drawing drawingOf(const Instant& instant) const {
    picture::Drawing drawing;
    const Colour pale = isDark() ? Colour{120, 124, 130} : Colour{205, 207, 210};
    const Colour wall = isDark() ? Colour{58, 62, 68} : Colour{228, 231, 235};
    drawing.paints = {{picture::coloursOf(grains_.palette)},
                      {picture::coloursOf(solids_.palette)},
                      {picture::coloursOf(lines_.palette)},
                      {{wall}, 1.0, 0.3},
                      {{Colour{92, 106, 130}}, 0.3},
                      {{pale}},
                      {{pale}}};
    addGrains(drawing, instant);
    for (const Solid& solid : scene_.solids)
      if (const io::FrameContent* const frame = instant.find("solid_" + solid.name); frame && options_.solids != "none")
        addSolid(drawing, *frame);
    if (options_.lines != "none") addLines(drawing, instant);
    return drawing;
  }

  void addGrains(picture::Drawing& drawing, const Instant& instant) const {
    const io::FrameContent* const frame = instant.find("grains");
    if (!frame || options_.grains == "none") return;
    const std::vector<double> radius = valuesAt(*frame, "radius", false),
                              value = valuesAt(*frame, grains_.hue.name, false);
    const bool plain = value.empty() || options_.lines != "none";
    for (std::size_t k = 0; k < radius.size(); ++k)
      if (!cut_ || cut_->height(frame->position[k]) <= 0.0)
        drawing.balls.push_back({frame->position[k], radius[k], plain ? 0.0F : grains_.place(value[k]),
                                 plain ? std::uint8_t{plainGrain} : std::uint8_t{ofGrains}});
  }

  void addSolid(picture::Drawing& drawing, const io::FrameContent& frame) const {
    std::vector<Vec3> place = frame.position;
    if (const io::FrameArray* const u = frame.find("displacement", false))
      for (std::size_t k = 0; k < place.size(); ++k)
        place[k] += options_.warp * Vec3{u->values[3 * k], u->values[3 * k + 1], u->values[3 * k + 2]};
    std::vector<float> value;
    for (const double v : ofSolid(frame)) value.push_back(solids_.place(v));
    const auto paint = value.empty() ? std::uint8_t{plainSolid} : std::uint8_t{ofSolids};
    for (const picture::Triangle& triangle : surfaceOf(frame, place, value, paint, cut_))
      drawing.triangles.push_back(triangle);
  }

  /// As thick as the force is large.
  void addLines(picture::Drawing& drawing, const Instant& instant) const {
    const io::FrameContent* const frame = instant.find(options_.lines);
    if (!frame) return;
    const std::vector<double> force = valuesAt(*frame, "normal_force", true);
    const double most = std::max(std::abs(lines_.range.low), std::abs(lines_.range.high)),
                 thick = 0.35 * meanRadius(drawing);
    for (std::size_t k = 0; 2 * k + 1 < frame->cellPoint.size(); ++k) {
      const Vec3 &a = frame->position[frame->cellPoint[2 * k]], &b = frame->position[frame->cellPoint[2 * k + 1]];
      if (cut_ && cut_->height(0.5 * (a + b)) > 0.0) continue;
      const double fraction = std::min(1.0, std::abs(force[k]) / most);
      drawing.rods.push_back({a, b, thick * (0.08 + 0.92 * std::sqrt(fraction)), lines_.place(force[k]), ofLines});
    }
  }

  double meanRadius(const picture::Drawing& drawing) const {
    double sum = 0.0;
    for (const picture::Ball& ball : drawing.balls) sum += ball.radius;
    return drawing.balls.empty() ? 0.01 * norm(box_.upper - box_.lower)
                                 : sum / static_cast<double>(drawing.balls.size());
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
    cut_ = Cut{axis, options_.cutAxis.empty() ? middle : options_.cutAt, camera_.back[axis] < 0.0 ? -1.0 : 1.0};
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

  static std::string timeText(double time) {
    const auto [factor, unit] = prefixed(time, "s");
    return report::format("t = %.4g ", time * factor) + unit;
  }

  static picture::Bar barOf(const Coloured& field, const char* of = "") {
    const auto [low, high] = field.range;
    const auto [factor, unit] = prefixed(std::max(std::abs(low), std::abs(high)), field.hue.unit);
    picture::Bar bar{field.hue.title + of + (unit.empty() ? "" : ", " + unit), picture::coloursOf(field.palette), {}};
    const std::vector<double> ticks = report::roundTicks(low * factor, high * factor, 6);
    const double most = std::max(std::abs(ticks.front()), std::abs(ticks.back()));
    const int digits = std::max(4, static_cast<int>(std::ceil(std::log10(most / (ticks[1] - ticks[0])))) + 1);
    for (const double tick : ticks) {
      const double fraction = (tick - low * factor) / ((high - low) * factor);
      const bool zero = std::abs(tick) < 1e-9 * (high - low) * factor;
      if (fraction > -1e-6 && fraction < 1.0 + 1e-6)
        bar.ticks.emplace_back(fraction, report::format("%.*g", digits, zero ? 0.0 : tick));
    }
    return bar;
  }

  /// Grains and solids are coloured by the same quantity, such as the speed.
  bool sharesQuantity() const {
    return grains_.hue.name == solids_.hue.name && !grains_.spread.isEmpty() && !solids_.spread.isEmpty();
  }

  picture::Legend legendOf(double time) const {
    picture::Legend legend;
    legend.time = timeText(time);
    if (cut_) legend.time += report::format(",  section at %c = %.3g m", "xyz"[cut_->axis], cut_ -> at);
    if (options_.warp != 1.0) legend.time += report::format(",  displacements × %.4g", options_.warp);
    if (isDark()) legend.ink = {225, 225, 225};
    if (!grains_.hue.name.empty() && !grains_.spread.isEmpty() && options_.lines == "none")
      legend.bars.push_back(barOf(grains_, sharesQuantity() ? " of grains" : ""));
    if (!lines_.spread.isEmpty()) legend.bars.push_back(barOf(lines_));
    if (!solids_.hue.name.empty() && !solids_.spread.isEmpty())
      legend.bars.push_back(barOf(solids_, sharesQuantity() ? " of solids" : ""));
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
  Coloured grains_, solids_, lines_;
  geometry::Box box_;
  std::optional<Cut> cut_;
  picture::Camera camera_;
  int height_ = 0;
};

std::string programMark() { return "dovetail " + io::buildInfo().version + " " + io::buildInfo().commit; }

}  // namespace

fs::path writePicture(const fs::path& folder, const PictureOptions& options, std::ostream& log) {
  const char* const ending = options.film ? ".gif" : ".png";
  const fs::path file = options.file.empty() ? folder / (options.film ? "film.gif" : "picture.png") : options.file;
  if (file.extension() != ending)
    throw InputError(options.film ? "films are GIF files" : "pictures are PNG files", file.string(),
                     std::string("give a name that ends in ") + ending);
  io::requireFreeOrOurs(file);
  Pictures pictures(folder, options);
  std::vector<std::size_t> which;
  if (!options.film) which.push_back(pictures.numberOf(options.frame));
  for (std::size_t k = 0; options.film && k < pictures.count(); ++k) which.push_back(k);
  pictures.prepare(which);
  if (!options.film) {
    const picture::Image image = pictures.draw(which[0], 3);
    io::writeFileAtomically(file, picture::pngOf(image, programMark(), pictures.caption(which[0])));
    log << pictures.caption(which[0]) << ": " << file.string() << '\n';
    return file;
  }
  std::vector<picture::Image> images;
  for (const std::size_t k : which) images.push_back(pictures.draw(k, 2));
  const double seconds = std::clamp(8.0 / static_cast<double>(images.size()), 0.03, 0.25);
  io::writeFileAtomically(file, picture::gifOf(images, seconds, programMark()));
  log << images.size() << " frames: " << file.string() << '\n';
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
