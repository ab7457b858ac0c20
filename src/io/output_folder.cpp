#include "dovetail/io/output_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::io {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& problem, const fs::path& path, const std::string& why) {
  throw InputError(problem + " (" + why + ")", path.string(),
                   "give a folder that you may write in, for instance ./out");
}

/// What a file of ours begins with, up to the number of the version: one kind of file, one beginning.
constexpr std::array<std::string_view, 12> beginnings{
    "# version: dovetail ",                                        // tables, texts
    "// version: dovetail ",                                       // scenes in full
    "<?xml version=\"1.0\"?>\n<!-- dovetail ",                     // series of frames
    "<!-- dovetail ",                                              // frames, figures, Markdown
    "<!doctype html>\n<!-- dovetail ",                             // pages
    "binary STL, dovetail ",                                       //
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\ndovetail ",  //
    "** dovetail ",                                                // meshes for Abaqus
    "DOVETAILdovetail ",                                           // states
    "# dovetail ",                                                 // packings
    "spheres, written by dovetail ",                               // packings for LAMMPS
    "\x89HDF\r\n\x1a\n",                                           // see isHdf5OfOurs
};
constexpr std::string_view hdf5 = beginnings.back();
/// Pictures name their program behind a head of fixed length: PNG in its text "Software", GIF in a comment.
constexpr std::array<std::pair<std::string_view, std::size_t>, 2> pictures{
    {{"\x89PNG\r\n\x1a\n", 50}, {"GIF89a", 784}}};
/// What JSON of ours begins with, white space left out.
constexpr std::array<std::string_view, 2> jsonBeginnings{"{\"provenance\":{\"version\":\"dovetail",
                                                         "{\"version\":\"dovetail"};

bool isDigit(char c) { return c >= '0' && c <= '9'; }

bool beginsWith(std::string_view head, std::string_view beginning) {
  return head.starts_with(beginning) && head.size() > beginning.size() && isDigit(head[beginning.size()]);
}

/// The first attribute that our writers put there: the first text in the heap of texts, behind two headers.
bool isHdf5OfOurs(std::string_view head) {
  constexpr std::size_t headers = 32;
  const std::size_t heap = head.find("GCOL");
  return heap != std::string::npos && heap + headers < head.size() &&
         beginsWith(head.substr(heap + headers), "dovetail ");
}

/// @param dense  JSON without white space
bool isJsonOfOurs(std::string_view dense) {
  for (const std::string_view& beginning : jsonBeginnings)
    if (beginsWith(dense, beginning)) {
      const std::string_view rest = dense.substr(beginning.size());
      return rest.substr(std::min(rest.find('"'), rest.size())).starts_with("\",\"commit\":");
    }
  return false;
}

/// The kind of file of ours that begins so; null: none.
const std::string_view* kindOf(std::string_view head) {
  for (const std::string_view& beginning : beginnings)
    if (beginning == hdf5 ? head.starts_with(hdf5) && isHdf5OfOurs(head) : beginsWith(head, beginning))
      return &beginning;
  for (const auto& [beginning, place] : pictures)
    if (head.starts_with(beginning) && head.size() > place)
      return beginsWith(head.substr(place), "dovetail ") ? &beginning : nullptr;
  if (!head.starts_with('{')) return nullptr;
  std::string dense;
  for (std::size_t k = 0; k < head.size() && dense.size() < 128; ++k)
    if (std::string_view(" \n").find(head[k]) == std::string_view::npos) dense += head[k];
  return isJsonOfOurs(dense) ? &jsonBeginnings[dense[2] == 'v'] : nullptr;
}

constexpr std::size_t headSize = 64 * 1024;

}  // namespace

bool isOurs(const fs::path& path) { return kindOf(headOf(path, headSize)) != nullptr; }

void requireFreeOrOurs(const fs::path& path) { dovetail::requireFreeOrOurs(path, isOurs); }

void removeOurs(const fs::path& path) {
  if (!writesFiles()) return;
  requireFreeOrOurs(path);
  std::error_code error;
  fs::remove(path, error);
  if (error) throw Error("a file of an earlier run cannot be removed (" + error.message() + ")", path.string(), "");
}

void writeFileAtomically(const fs::path& path, const std::string& text, Survives survives) {
  if (!writesFiles()) return;
  const std::string_view *const kind = kindOf(std::string_view(text).substr(0, headSize)), *const before = kindOf(
                                                                                               headOf(path, headSize));
  if (before && before != kind)
    throw InputError("a file of another kind is there already", path.string(), "give another name");
  replaceFile(path, {text}, isOurs, survives);
}

fs::path prepareOutputFolder(const fs::path& folder, const std::vector<std::string>& fileNames) {
  if (folder.empty()) throw InputError("the output folder has no name", "output folder", "give one, for instance out");
  if (!writesFiles()) return folder;
  std::error_code error;
  fs::create_directories(folder, error);
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    if (fs::exists(folder, ignored)) refuse("the output folder is a file", folder, "not a directory");
    refuse("the output folder cannot be made", folder, error ? error.message() : "not a directory");
  }
  requireWritable(folder);
  removeLeftovers(folder, isOurs);
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (fs::is_directory(entry.symlink_status(ignored)) && isOurs(entry.path().string() + ".pvd"))
      removeLeftovers(entry.path(), isOurs);
  for (const std::string& name : fileNames) requireFreeOrOurs(folder / name);
  return folder;
}

fs::path prepareInnerFolder(const fs::path& folder, const std::vector<std::string>& fileNames) {
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(folder, error)))
    throw InputError("a link has the name of a folder of the run", folder.string(), "move it, or give another folder");
  return prepareOutputFolder(folder, fileNames);
}

void removeFrames(const fs::path& folder, const std::string& name) {
  if (!writesFiles()) return;
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(folder, error))) return;
  std::vector<fs::path> frames;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string file = entry.path().stem().string(), ending = entry.path().extension().string();
    const bool isNumbered =
        file.starts_with(name + "_") && file.size() > name.size() + 1 &&
        std::all_of(file.begin() + static_cast<std::ptrdiff_t>(name.size()) + 1, file.end(), isDigit);
    if (isNumbered && (ending == ".vtu" || ending == ".vtp") && isOurs(entry.path())) frames.push_back(entry.path());
  }
  for (const fs::path& frame : frames) removeOurs(frame);
  fs::remove(folder, error);  // which leaves folders that are not empty
}

void removeReport(const fs::path& folder) {
  const fs::path text = folder / "report.md";
  if (isOurs(text)) {
    std::ifstream stream(text);
    const std::string links{std::istreambuf_iterator<char>(stream), {}};
    std::vector<fs::path> figures;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      const bool isFigure = name.starts_with("report_") && name.ends_with(".svg");
      if (isFigure && links.find("(" + name + ")") != std::string::npos && isOurs(entry.path()))
        figures.push_back(entry.path());
    }
    for (const fs::path& figure : figures) removeOurs(figure);
  }
  for (const fs::path& page : {text, folder / "report.html", folder / "report_picture.png"})
    if (isOurs(page)) removeOurs(page);
}

void requireNoRun(const fs::path& folder) {
  if (!writesFiles()) return;
  const auto refuseRun = [&](const fs::path& file, const char* remedy) {
    throw InputError("there is a run in this folder, with " + file.filename().string(), folder.string(),
                     std::string(remedy) + ", or another folder by --out");
  };
  if (!isOurs(folder / "summary.json") && isOurs(folder / "checkpoint.state"))
    refuseRun("checkpoint.state", "resume it, or give --replace");
  for (const char* const name : {"summary.json", "series.csv", "series.h5", "scene.json", "report.md", "report.html"})
    if (isOurs(folder / name)) refuseRun(name, "give --replace to replace it by this one");
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (const std::string ending = entry.path().extension().string();
        (ending == ".pvd" || ending == ".vtkhdf") && isOurs(entry.path()))
      refuseRun(entry.path(), "give --replace to replace it by this one");
}

FolderOnTrial::FolderOnTrial(const fs::path& folder) {
  std::error_code error;
  fs::path inner = fs::absolute(folder, error).lexically_normal();
  if (!inner.has_filename()) inner = inner.parent_path();
  for (; !inner.empty() && !fs::exists(fs::symlink_status(inner, error)); inner = inner.parent_path())
    missing_.push_back(inner);
}

FolderOnTrial::~FolderOnTrial() {
  if (!held_) return;
  std::error_code error;
  for (const fs::path& folder : missing_) fs::remove(folder, error);  // which leaves folders that are not empty
}

FolderLock::FolderLock(const fs::path& folder)
    : descriptor_(writesFiles() ? ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw InputError("another run writes into this folder", folder.string(),
                   "wait until it has ended, or give another folder");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace dovetail::io
