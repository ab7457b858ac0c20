#include "shown_fields.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <ostream>

#include "cell_faces.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/nearest.hpp"
#include "dovetail/report/figure.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::scene {

using picture::Colour;

namespace {

std::string choose(const std::string& wanted, const std::vector<std::string>& there,
                   std::initializer_list<const char*> order, const std::string& option) {
  const auto has = [&](const std::string& name) { return std::find(there.begin(), there.end(), name) != there.end(); };
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

picture::Bar barOf(const ShownFields::Coloured& field, const char* of = "") {
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

}  // namespace

ShownFields::ShownFields(const PictureOptions& options, const Scene& scene, bool isDark,
                         const std::vector<Instant>& instants)
    : options_(options), scene_(scene), isDark_(isDark) {
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
  solids_ = {quantityNamed(choose(options_.solids, ofSolidFrames, {"shape", "von_mises", "displacement"}, "--solids")),
             picture::Palette::warm};
  lines_ = {quantityNamed("normal_force"), picture::Palette::warm};
  lines_.hue.signs = options_.lines == "bonds";
}

std::vector<double> ShownFields::ofSolid(const io::FrameContent& frame) const {
  if (solids_.hue.name.empty()) return {};
  std::vector<double> values = valuesAt(frame, solids_.hue.name, false);
  if (!values.empty()) return values;
  values = valuesAt(frame, solids_.hue.name, true);
  return values.empty() ? values : atPoints(frame, values);
}

void ShownFields::spreadOver(const Instant& instant) {
  if (const io::FrameContent* const grains = instant.find("grains"); grains && !grains_.hue.name.empty())
    grains_.spread.add(valuesAt(*grains, grains_.hue.name, false));
  for (const Solid& solid : scene_.solids)
    if (const io::FrameContent* const frame = instant.find("solid_" + solid.name)) solids_.spread.add(ofSolid(*frame));
  if (const io::FrameContent* const lines = instant.find(options_.lines))
    lines_.spread.add(valuesAt(*lines, "normal_force", true));
}

void ShownFields::endRanges() {
  for (Coloured* const field : {&grains_, &solids_, &lines_}) field->range = field->spread.range(field->hue.signs);
  if (sharesQuantity())
    grains_.range = solids_.range = {std::min(grains_.range.low, solids_.range.low),
                                     std::max(grains_.range.high, solids_.range.high)};
  if (options_.grainRange) grains_.range = *options_.grainRange;
  if (options_.solidRange) solids_.range = *options_.solidRange;
  for (Coloured* const field : {&grains_, &solids_, &lines_})
    if (field->hue.signs && field->range.low < 0.0 && field->range.high > 0.0) field->palette = picture::Palette::signs;
}

picture::Drawing ShownFields::drawingOf(const Instant& instant, const std::optional<Cut>& cut, double size) const {
  picture::Drawing drawing;
  const Colour pale = isDark_ ? Colour{120, 124, 130} : Colour{205, 207, 210};
  const Colour wall = isDark_ ? Colour{58, 62, 68} : Colour{228, 231, 235};
  drawing.paints = {{picture::coloursOf(grains_.palette)},
                    {picture::coloursOf(solids_.palette)},
                    {picture::coloursOf(lines_.palette)},
                    {{wall}, 1.0, 0.3},
                    {{Colour{92, 106, 130}}, 0.3},
                    {{pale}},
                    {{pale}}};
  addGrains(drawing, instant, cut);
  for (const Solid& solid : scene_.solids)
    if (const io::FrameContent* const frame = instant.find("solid_" + solid.name); frame && options_.solids != "none")
      addSolid(drawing, *frame, cut);
  if (options_.lines != "none") addLines(drawing, instant, cut, meanRadius(drawing, size));
  return drawing;
}

void ShownFields::addGrains(picture::Drawing& drawing, const Instant& instant, const std::optional<Cut>& cut) const {
  const io::FrameContent* const frame = instant.find("grains");
  if (!frame || options_.grains == "none") return;
  const std::vector<double> radius = valuesAt(*frame, "radius", false),
                            value = valuesAt(*frame, grains_.hue.name, false);
  const bool plain = value.empty() || options_.lines != "none";
  for (std::size_t k = 0; k < radius.size(); ++k)
    if (!cut || cut->height(frame->position[k]) <= 0.0)
      drawing.balls.push_back({frame->position[k], radius[k], plain ? 0.0F : grains_.place(value[k]),
                               plain ? std::uint8_t{plainGrain} : std::uint8_t{ofGrains}});
}

void ShownFields::addSolid(picture::Drawing& drawing, const io::FrameContent& frame,
                           const std::optional<Cut>& cut) const {
  std::vector<Vec3> place = frame.position;
  if (const io::FrameArray* const u = frame.find("displacement", false))
    for (std::size_t k = 0; k < place.size(); ++k)
      place[k] += options_.warp * Vec3{u->values[3 * k], u->values[3 * k + 1], u->values[3 * k + 2]};
  std::vector<float> value;
  for (const double v : ofSolid(frame)) value.push_back(solids_.place(v));
  const auto paint = value.empty() ? std::uint8_t{plainSolid} : std::uint8_t{ofSolids};
  if (const std::vector<double> radius = valuesAt(frame, "radius", false); !radius.empty()) {
    for (std::size_t k = 0; k < place.size(); ++k)
      if (!cut || cut->height(place[k]) <= 0.0)
        drawing.balls.push_back({place[k], radius[k], value.empty() ? 0.0F : value[k], paint});
    return;
  }
  for (const picture::Triangle& triangle : surfaceOf(frame, place, value, paint, cut))
    drawing.triangles.push_back(triangle);
}

/// As thick as the force is large.
void ShownFields::addLines(picture::Drawing& drawing, const Instant& instant, const std::optional<Cut>& cut,
                           double radius) const {
  const io::FrameContent* const frame = instant.find(options_.lines);
  if (!frame) return;
  const std::vector<double> force = valuesAt(*frame, "normal_force", true);
  const double most = std::max(std::abs(lines_.range.low), std::abs(lines_.range.high)), thick = 0.35 * radius;
  for (std::size_t k = 0; 2 * k + 1 < frame->cellPoint.size(); ++k) {
    const Vec3 &a = frame->position[frame->cellPoint[2 * k]], &b = frame->position[frame->cellPoint[2 * k + 1]];
    if (cut && cut->height(0.5 * (a + b)) > 0.0) continue;
    const double fraction = std::min(1.0, std::abs(force[k]) / most);
    drawing.rods.push_back({a, b, thick * (0.08 + 0.92 * std::sqrt(fraction)), lines_.place(force[k]), ofLines});
  }
}

double ShownFields::meanRadius(const picture::Drawing& drawing, double size) {
  double sum = 0.0;
  for (const picture::Ball& ball : drawing.balls) sum += ball.radius;
  return drawing.balls.empty() ? 0.01 * size : sum / static_cast<double>(drawing.balls.size());
}

bool ShownFields::sharesQuantity() const {
  return grains_.hue.name == solids_.hue.name && !grains_.spread.isEmpty() && !solids_.spread.isEmpty();
}

std::vector<picture::Bar> ShownFields::bars() const {
  std::vector<picture::Bar> all;
  if (!grains_.hue.name.empty() && !grains_.spread.isEmpty() && options_.lines == "none")
    all.push_back(barOf(grains_, sharesQuantity() ? " of grains" : ""));
  if (!lines_.spread.isEmpty()) all.push_back(barOf(lines_));
  if (!solids_.hue.name.empty() && !solids_.spread.isEmpty())
    all.push_back(barOf(solids_, sharesQuantity() ? " of solids" : ""));
  return all;
}

std::string ShownFields::caption() const {
  return (grains_.hue.name.empty() ? "" : "; grains: " + grains_.hue.title) +
         (solids_.hue.name.empty() ? "" : "; solids: " + solids_.hue.title);
}

}  // namespace dovetail::scene
