// A picture of a run as it is now.
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/scene/picture.hpp"
#include "dovetail/scene/read.hpp"
#include "run/frames.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

/// A folder of its own that is gone in the end.
class PassingFolder {
public:
  PassingFolder() {
    std::string name = (fs::temp_directory_path() / "dovetail-picture-XXXXXX").string();
    if (!::mkdtemp(name.data()))
      throw Error("no folder for a frame can be made", fs::temp_directory_path().string(), "check for free disk space");
    path = name;
  }
  ~PassingFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;

  fs::path path;
};

}  // namespace

Picture drawPicture(const Built& built, const Scene& scene, const PictureOptions& options) {
  if (options.film || options.mode)
    throw InputError("a run as it is now has one picture", "picture", "draw films and modes from a folder");
  Scene shown = scene;
  std::vector<std::string>& contents = shown.output.contents;
  if (options.lines != "none" && std::ranges::find(contents, options.lines) == contents.end())
    contents.push_back(options.lines);
  const PassingFolder folder;
  const io::KeyValues provenance = io::provenance();
  io::writeFileAtomically(folder.path / "scene.json", io::provenanceLines(provenance, "// ") + sceneText(shown));
  Frames(built, shown, folder.path, provenance, {}).add(built);
  return drawPicture(folder.path, options);
}

}  // namespace dovetail::scene
