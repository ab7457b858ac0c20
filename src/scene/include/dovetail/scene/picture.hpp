// Pictures and films of a run's frames.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>

namespace dovetail::scene {

/// Values of the colours' ends.
struct ColourRange {
  double low = 0.0, high = 1.0;
};

struct PictureOptions {
  bool film = false;                         ///< all frames as a GIF, otherwise one as a PNG
  int frame = -1;                            ///< from 0; negative: from the end
  std::optional<int> mode;                   ///< of the solids, from 1, in the place of a frame; films show all of them
  std::string cell;                          ///< grains of this cell of the output, in place of the run's
  std::optional<double> azimuth, elevation;  ///< of the viewer, degrees; not given: from shape and gravity
  std::string grains, solids;                ///< fields that colour them, or "none"; empty: the first that frames have
  std::string lines = "none";                ///< "contacts" or "bonds": rods, coloured by the normal force
  std::string cutAxis;                       ///< x, y, z or none; empty: through the middle of scenes with overlaps
  double cutAt = 0.0;                        ///< m; what lies before it is not drawn
  double warp = 1.0;                         ///< displacements are drawn so many times as large
  std::optional<ColourRange> grainRange, solidRange;  ///< SI units
  int width = 1200, height = 0;                       ///< pixels; height 0: as the scene needs
  std::string background = "white";                   ///< or black, or "\#" and six hexadecimal digits
  std::filesystem::path file;  ///< .png, or .gif of films; empty: picture.png or film.gif in the folder
};

/// Draws frames of a run: grains as spheres, solids with the lines of their elements, walls that do not hide what they
/// hold, in a parallel projection with gravity downwards, with colour bars, scale bar, axes and time. Needs no display.
/// Values of cells are averaged at the nodes. Colours of a film mean the same in all of its frames; one in a thousand
/// values may lie beyond their ends.
/// @return the file. @throws InputError for options out of range, if there is no run, no frame, no such field, or in
/// builds without VTK and zlib
std::filesystem::path writePicture(const std::filesystem::path& folder, const PictureOptions& options,
                                   std::ostream& log);

/// Bytes of a PNG or GIF file, and what it shows.
struct Picture {
  std::string bytes, caption;
};
/// The same without a file. @throws InputError as writePicture
Picture drawPicture(const std::filesystem::path& folder, const PictureOptions& options);
struct Built;
struct Scene;
/// Of a run as it is now, by a frame of its own with the contents of the scene's output, and lines that are asked for:
/// what writePicture draws of that frame.
/// @throws InputError as writePicture, and for films and modes, which are those of folders
Picture drawPicture(const Built& built, const Scene& scene, const PictureOptions& options);

/// The last frame for a report: bytes of a PNG file, and what it shows, or why there is none. Both are empty without
/// frames, and in builds without VTK and zlib.
struct ShownRun {
  std::string png, caption;
};
ShownRun showRun(const std::filesystem::path& folder);

}  // namespace dovetail::scene
