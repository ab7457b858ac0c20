#include "dovetail/io/output_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "dovetail/core/error.hpp"

namespace dovetail::io {

namespace {

namespace fs = std::filesystem;

std::string reason(int code) { return std::strerror(code); }

[[noreturn]] void refuse(const std::string& problem, const fs::path& path, const std::string& why) {
  throw InputError(problem + " (" + why + ")", path.string(),
                   "give a folder that you may write in, for instance ./out");
}

/// A file descriptor that is closed when it goes out of scope.
struct Descriptor {
  int number;
  explicit Descriptor(int n) : number(n) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

/// A new, empty file beside `path`; the name is free, also when several programs write to one folder.
int openTemporary(const fs::path& path, fs::path& temporary) {
  static std::atomic<int> count{0};
  for (int attempt = 0; attempt < 1000; ++attempt) {
    temporary = path;
    temporary += ".part-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) return file;
    if (errno != EEXIST) refuse("a file cannot be written", path, reason(errno));
  }
  refuse("a file cannot be written", path, "no free temporary name");
}

/// Returns 0, or the errno of the first failure.
int writeAll(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(file, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    done += static_cast<std::size_t>(count);
  }
  return 0;
}

}  // namespace

bool isOurs(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(path, error))) return false;
  std::string head(64 * 1024, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  const std::string mark = "dovetail ";
  for (std::size_t at = head.find(mark); at != std::string::npos; at = head.find(mark, at + 1)) {
    const std::size_t next = at + mark.size();
    if (next < head.size() && std::isdigit(static_cast<unsigned char>(head[next]))) return true;
  }
  return false;
}

void requireFreeOrOurs(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::not_found || isOurs(path)) return;
  if (status.type() == fs::file_type::none) refuse("a file cannot be written", path, error.message());
  throw InputError("something that is not from an earlier run is there already", path.string(),
                   "move it, or give another folder");
}

namespace {

/// Renames the complete file; where `path` is taken by others, the temporary stays.
void replaceWith(const fs::path& temporary, const fs::path& path) {
  std::error_code error;
  const bool replaces = fs::symlink_status(path, error).type() != fs::file_type::not_found;
  if (replaces && !isOurs(path))
    throw InputError("something that is not from an earlier run is there already", path.string(),
                     "the new file is " + temporary.string() + "; move one of them");
  if (replaces) {
    // Without this, a power cut after the rename could leave an empty file where a complete one was.
    const Descriptor file(::open(temporary.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.number < 0 || ::fsync(file.number) != 0)
      throw Error("a file cannot be completed (" + reason(errno) + ")", temporary.string(), "check the disk");
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0)
    throw Error("a file cannot be renamed (" + reason(errno) + ")", path.string(),
                "the new file is " + temporary.string());
}

}  // namespace

void writeFileAtomically(const fs::path& path, const std::string& text) {
  fs::path temporary;
  int failure = 0;
  {
    const Descriptor file(openTemporary(path, temporary));
    failure = writeAll(file.number, text);
  }
  if (failure != 0) {
    ::unlink(temporary.c_str());
    throw Error("writing broke off (" + reason(failure) + ")", path.string(), "free some space, or give another disk");
  }
  replaceWith(temporary, path);
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
  fs::path probe;
  int failure = 0;
  {
    const Descriptor file(openTemporary(folder / "probe", probe));
    failure = writeAll(file.number, "dovetail");
  }
  ::unlink(probe.c_str());
  if (failure != 0) refuse("a file cannot be written", folder, reason(failure));
  for (const std::string& name : fileNames) requireFreeOrOurs(folder / name);
  return folder;
}

}  // namespace dovetail::io
