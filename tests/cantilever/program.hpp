// Runs the cantilever program as a user does.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "../io/scratch_folder.hpp"

namespace dovetail::cantilever::test {

struct Outcome {
  int code;  ///< −1 if a signal ended the program
  std::string out, err;
};

inline Outcome runProgram(const std::vector<std::string>& options) {
  const io::test::ScratchFolder scratch;
  const std::string out = (scratch / "out").string(), err = (scratch / "err").string();
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0600);
  std::vector<char*> words{const_cast<char*>(TEST_PROGRAM)};
  for (const std::string& option : options) words.push_back(const_cast<char*>(option.c_str()));
  words.push_back(nullptr);
  pid_t child = 0;
  const int failure = posix_spawn(&child, TEST_PROGRAM, &files, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failure != 0) throw std::runtime_error(std::string("cannot start ") + TEST_PROGRAM);
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, io::test::readText(out), io::test::readText(err)};
}

/// Every file below the folder with its bytes, and every folder.
inline std::map<std::string, std::string> everyByte(const io::test::ScratchFolder& folder) {
  std::map<std::string, std::string> bytes;
  for (const std::string& name : folder.content())
    bytes[name] = std::filesystem::is_directory(folder / name) ? "folder" : io::test::readText(folder / name);
  return bytes;
}

}  // namespace dovetail::cantilever::test
