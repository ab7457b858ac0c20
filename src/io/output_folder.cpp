#include "dovetail/io/output_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::io {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& problem, const fs::path& path, const std::string& why) {
  throw InputError(problem + " (" + why + ")", path.string(),
                   "give a folder that you may write in, for instance ./out");
}

}  // namespace

bool isOurs(const fs::path& path) {
  const std::string head = headOf(path, 64 * 1024), mark = "dovetail ";
  for (std::size_t at = head.find(mark); at != std::string::npos; at = head.find(mark, at + 1)) {
    const std::size_t next = at + mark.size();
    if (next < head.size() && std::isdigit(static_cast<unsigned char>(head[next]))) return true;
  }
  return false;
}

void requireFreeOrOurs(const fs::path& path) { dovetail::requireFreeOrOurs(path, isOurs); }

void removeOurs(const fs::path& path) {
  requireFreeOrOurs(path);
  std::error_code error;
  fs::remove(path, error);
  if (error) throw Error("a file of an earlier run cannot be removed (" + error.message() + ")", path.string(), "");
}

void writeFileAtomically(const fs::path& path, const std::string& text, Survives survives) {
  replaceFile(path, {text}, isOurs, survives);
}

fs::path prepareOutputFolder(const fs::path& folder, const std::vector<std::string>& fileNames) {
  if (folder.empty()) throw InputError("the output folder has no name", "output folder", "give one, for instance out");
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
    if (fs::is_directory(entry.symlink_status(ignored))) removeLeftovers(entry.path(), isOurs);
  for (const std::string& name : fileNames) requireFreeOrOurs(folder / name);
  return folder;
}

FolderOnTrial::FolderOnTrial(const fs::path& folder) {
  std::error_code error;
  fs::path inner = fs::absolute(folder, error).lexically_normal();
  if (!inner.has_filename()) inner = inner.parent_path();
  for (; !inner.empty() && !fs::exists(fs::symlink_status(inner, error)); inner = inner.parent_path())
    missing_.push_back(inner);
}

FolderOnTrial::~FolderOnTrial() {
  std::error_code error;
  for (const fs::path& folder : missing_) fs::remove(folder, error);  // which leaves folders that are not empty
}

FolderLock::FolderLock(const fs::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw InputError("another run writes into this folder", folder.string(),
                   "wait until it has ended, or give another folder");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace dovetail::io
