#include "dovetail/core/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>

#include "dovetail/core/error.hpp"
#include "dovetail/core/team.hpp"

namespace dovetail {

namespace {

namespace fs = std::filesystem;

std::string reason(int code) { return std::strerror(code); }

[[noreturn]] void breakOff(const fs::path& path, int code) {
  throw Error("writing broke off (" + reason(code) + ")", path.string(), "free some space, or give another disk");
}

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw InputError("a file cannot be written (" + why + ")", path.string(),
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
    if (errno != EEXIST) refuse(path, reason(errno));
  }
  refuse(path, "no free temporary name");
}

/// Returns 0, or the errno of the first failure.
int writeAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

/// Returns 0, or the errno of the first failure.
int fill(int file, std::initializer_list<std::string_view> pieces, Survives survives) {
  for (const std::string_view piece : pieces)
    if (const int failure = writeAll(file, piece); failure != 0) return failure;
  if (survives == Survives::kills) return 0;
  return ::fsync(file) == 0 || errno == EINVAL ? 0 : errno;
}

/// The process in "<name>.part-<process>-<number>"; nothing for other names.
std::optional<pid_t> writerOf(const std::string& name) {
  const auto isNumber = [](std::string_view text) {
    return !text.empty() && text.size() < 10 &&
           std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  };
  const std::string mark = ".part-";
  const std::size_t at = name.rfind(mark);
  if (at == std::string::npos) return {};
  const std::string_view numbers = std::string_view(name).substr(at + mark.size());
  const std::size_t dash = numbers.find('-');
  if (dash == std::string_view::npos || !isNumber(numbers.substr(0, dash)) || !isNumber(numbers.substr(dash + 1)))
    return {};
  return static_cast<pid_t>(std::stol(std::string(numbers.substr(0, dash))));
}

/// A program that is killed between making a file and filling it leaves one without a mark, but also without content;
/// its name is one that we give.
bool isEmptyOfDeadProgram(const fs::directory_entry& entry, pid_t writer) {
  constexpr std::array endings{".json", ".csv", ".txt", ".state", ".h5",  ".vtkhdf", ".vtu",
                               ".vtp",  ".pvd", ".vti", ".html",  ".svg", ".md"};
  const std::string name = entry.path().filename().string();
  const std::string ending = fs::path(name.substr(0, name.rfind(".part-"))).extension().string();
  if (std::find(endings.begin(), endings.end(), ending) == endings.end()) return false;
  std::error_code error;
  return fs::is_regular_file(entry.symlink_status(error)) && entry.file_size(error) == 0 && !error &&
         ::kill(writer, 0) != 0 && errno == ESRCH;
}

}  // namespace

bool writesFiles() { return team().rank() == 0; }

std::ifstream openFile(const fs::path& path, std::ios::openmode mode) {
  std::error_code error;
  std::ifstream file;
  if (fs::is_regular_file(path, error))
    file.open(path, mode | std::ios::in);
  else
    file.setstate(std::ios::failbit);
  return file;
}

std::string headOf(const fs::path& path, std::size_t size) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(path, error))) return {};
  std::string head(size, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

void requireFreeOrOurs(const fs::path& path, IsOurs isOurs) {
  if (!writesFiles()) return;
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::not_found || isOurs(path)) return;
  if (status.type() == fs::file_type::none) refuse(path, error.message());
  throw InputError("there is a file of this name that is not from an earlier run", path.string(),
                   "move it, or give another name or folder");
}

void requireWritable(const fs::path& folder) {
  if (!writesFiles()) return;
  fs::path probe;
  const Descriptor file(openTemporary(folder / "probe", probe));
  const int failure = fill(file.number, {"dovetail"}, Survives::powerCuts);
  ::unlink(probe.c_str());
  if (failure != 0) refuse(folder, reason(failure));
}

void replaceFile(const fs::path& path, std::initializer_list<std::string_view> pieces, IsOurs isOurs,
                 Survives survives) {
  if (!writesFiles()) return;
  std::error_code unknown;
  if (const fs::file_status status = fs::symlink_status(path, unknown);
      fs::exists(status) && !fs::is_regular_file(status))
    throw InputError("there is something other than a regular file of this name", path.string(), "give another name");
  fs::path temporary;
  const Descriptor file(openTemporary(path, temporary));
  ::flock(file.number, LOCK_EX | LOCK_NB);  // until it is renamed: see removeLeftovers
  if (const int failure = fill(file.number, pieces, survives); failure != 0) {
    ::unlink(temporary.c_str());
    breakOff(path, failure);
  }
  std::error_code error;
  if (fs::symlink_status(path, error).type() != fs::file_type::not_found && !isOurs(path))
    throw InputError("there is a file of this name that is not from an earlier run", path.string(),
                     "the new file is " + temporary.string() + "; move one of them");
  if (::rename(temporary.c_str(), path.c_str()) != 0)
    throw Error("a file cannot be renamed (" + reason(errno) + ")", path.string(),
                "the new file is " + temporary.string());
}

void appendToFile(const fs::path& path, std::string_view bytes, IsOurs isOurs) {
  if (!writesFiles()) return;
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC));
  if (file.number < 0) refuse(path, reason(errno));
  requireFreeOrOurs(path, isOurs);
  const off_t size = ::lseek(file.number, 0, SEEK_END);
  const int failure = writeAll(file.number, bytes);
  if (failure == 0) return;
  if (::ftruncate(file.number, size) != 0) breakOff(path, errno);
  breakOff(path, failure);
}

void removeLeftovers(const fs::path& folder, IsOurs isOurs) {
  if (!writesFiles()) return;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::optional<pid_t> writer = writerOf(entry.path().filename().string());
    if (!writer || (!isOurs(entry.path()) && !isEmptyOfDeadProgram(entry, *writer))) continue;
    const Descriptor file(::open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
    // A program that still writes it holds it locked.
    if (file.number >= 0 && ::flock(file.number, LOCK_EX | LOCK_NB) == 0) ::unlink(entry.path().c_str());
  }
}

}  // namespace dovetail
