// Grains, solids and lines of frames in the colours of their fields.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cell_faces.hpp"
#include "dovetail/picture/legend.hpp"
#include "quantities.hpp"
#include "run_frames.hpp"
#include "view.hpp"

namespace dovetail::scene {

/// Numbers of a drawing's paints.
enum Paints : std::uint8_t { ofGrains, ofSolids, ofLines, ofWalls, ofClearWalls, plainSolid, plainGrain };

class ShownFields {
public:
  /// A field with the ends of its colours.
  struct Coloured {
    Hue hue;
    picture::Palette palette = picture::Palette::cold;
    Spread spread{};
    ColourRange range{};
    float place(double value) const { return static_cast<float>((value - range.low) / (range.high - range.low)); }
  };

  /// Those that the options name, or the first that these frames have. Options and scene are kept by reference.
  /// @throws InputError for a field that none of them has
  ShownFields(const PictureOptions& options, const Scene& scene, bool isDark, const std::vector<Instant>& instants);

  /// The ends of colours are to enclose these values.
  void spreadOver(const Instant& instant);
  /// After all of them.
  void endRanges();

  /// All but walls. @param size  of what is shown, m
  picture::Drawing drawingOf(const Instant& instant, const std::optional<Cut>& cut, double size) const;
  /// Of the grains; without grains a hundredth of the size.
  static double meanRadius(const picture::Drawing& drawing, double size);
  std::vector<picture::Bar> bars() const;
  /// What the colours tell.
  std::string caption() const;

private:
  std::vector<double> ofSolid(const io::FrameContent& frame) const;
  void addGrains(picture::Drawing& drawing, const Instant& instant, const std::optional<Cut>& cut) const;
  void addSolid(picture::Drawing& drawing, const io::FrameContent& frame, const std::optional<Cut>& cut) const;
  void addLines(picture::Drawing& drawing, const Instant& instant, const std::optional<Cut>& cut, double radius) const;
  /// Grains and solids are coloured by the same quantity, such as the speed.
  bool sharesQuantity() const;

  const PictureOptions& options_;
  const Scene& scene_;
  bool isDark_;
  Coloured grains_, solids_, lines_;
};

}  // namespace dovetail::scene
