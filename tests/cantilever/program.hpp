// Runs the cantilever program as a user does.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../io/scratch_folder.hpp"

namespace dovetail::cantilever::test {

struct Outcome {
  int code;  ///< −1 if a signal ended the program
  std::string out, err;
};

/// The program at work. Signals to end have their usual meaning for it, whoever runs the test.
class Running {
public:
  explicit Running(const std::vector<std::string>& options) {
    const std::string out = (scratch_ / "out").string(), err = (scratch_ / "err").string();
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t signals;
    sigemptyset(&signals);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, number);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    std::vector<char*> words{const_cast<char*>(TEST_PROGRAM)};
    for (const std::string& option : options) words.push_back(const_cast<char*>(option.c_str()));
    words.push_back(nullptr);
    const int failure = posix_spawn(&child_, TEST_PROGRAM, &files, &attributes, words.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0) throw std::runtime_error(std::string("cannot start ") + TEST_PROGRAM);
  }
  ~Running() {
    if (child_ == 0) return;
    ::kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// Waits until the file holds the text; false if that takes a minute or the program has ended.
  bool awaits(const std::filesystem::path& file, const std::string& text) {
    siginfo_t end{};
    for (int look = 0; look < 6000; ++look) {
      if (io::test::readText(file).find(text) != std::string::npos) return true;
      if (waitid(P_PID, static_cast<id_t>(child_), &end, WEXITED | WNOHANG | WNOWAIT) == 0 && end.si_pid != 0) break;
      ::usleep(10000);
    }
    return false;
  }
  void signal(int number) { ::kill(child_, number); }
  Outcome outcome() {
    int status = 0;
    waitpid(std::exchange(child_, 0), &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, io::test::readText(scratch_ / "out"),
            io::test::readText(scratch_ / "err")};
  }

private:
  io::test::ScratchFolder scratch_;
  pid_t child_ = 0;
};

/// Runs it to its end. @param options  words of its command line
inline Outcome runProgram(const std::vector<std::string>& options) { return Running(options).outcome(); }

/// Every file below the folder with its bytes, and every folder.
inline std::map<std::string, std::string> everyByte(const io::test::ScratchFolder& folder) {
  std::map<std::string, std::string> bytes;
  for (const std::string& name : folder.content())
    bytes[name] = std::filesystem::is_directory(folder / name) ? "folder" : io::test::readText(folder / name);
  return bytes;
}

}  // namespace dovetail::cantilever::test
