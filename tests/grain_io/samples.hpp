// Files as the codes write them, in `samples`: most hold the same three spheres.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "dovetail/core/error.hpp"
#include "dovetail/grain_io/grain_files.hpp"

namespace dovetail::grain_io::test {

inline std::filesystem::path sample(const std::string& name) { return std::filesystem::path(SAMPLES) / name; }

inline std::string textOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A text in a file of its own, which goes with it.
class Written {
public:
  explicit Written(const std::string& text) : path_(std::filesystem::temp_directory_path() / nameOf(this)) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~Written() { std::filesystem::remove(path_); }
  Written(const Written&) = delete;
  Written& operator=(const Written&) = delete;
  const std::filesystem::path& path() const { return path_; }

private:
  static std::string nameOf(const void* self) {
    return "grain-io-" + std::to_string(getpid()) + "-" + std::to_string(reinterpret_cast<std::uintptr_t>(self));
  }
  std::filesystem::path path_;
};

/// By whichever reader knows the text.
inline GrainFile read(const std::filesystem::path& path, std::int64_t frame = -1) {
  switch (codeOf(textOf(path), path.string())) {
    case Code::lammps:
      return readLammps(path, Units::ofFile, frame);
    case Code::mercury:
      return readMercury(path, frame);
    default:
      return readYade(path);
  }
}

template <class Action>
std::string refusal(Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}
inline std::string refusalOf(const std::string& text) {
  const Written file(text);
  return refusal([&] { read(file.path()); });
}

/// Whether an error says what is expected, "line 3: the problem" or the problem alone.
inline bool says(const std::string& error, const std::string& expected) {
  const auto has = [&](const std::string& part) { return error.find(part) != std::string::npos; };
  const auto colon = expected.find(": ");
  if (!expected.starts_with("line ") || colon == std::string::npos) return has(expected);
  return has(", " + expected.substr(0, colon) + "]") && has(expected.substr(colon + 2));
}

/// With the first `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("the text has no " + from);
  return text.replace(at, from.size(), to);
}

}  // namespace dovetail::grain_io::test
