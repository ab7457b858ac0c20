#include "program/run.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <new>
#include <optional>
#include <thread>

#include "dovetail/core/error.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/io/interruption.hpp"

namespace dovetail::program {

namespace {

struct Ending {
  int code = 0;
  std::string text;  ///< of an error
};

Ending endingOf(const std::function<bool()>& body) {
  try {
    if (body()) return {};
    return {io::interruption() != 0 ? 128 + io::interruption() : 1, ""};
  } catch (const InputError& error) {
    return {2, error.what()};
  } catch (const std::bad_alloc&) {
    return {1, "there is not enough memory: take fewer grains or cells, or a machine with more"};
  } catch (const std::exception& error) {
    return {1, error.what()};
  }
}

/// Ranks that go on would wait for this one. What went wrong on all of them the first one tells, and ends the others.
[[noreturn]] void leaveTeam(const std::string& name, const Ending& ending) {
  if (team().rank() > 0) {
    std::this_thread::sleep_for(std::chrono::seconds(3));
    if (!ending.text.empty())
      std::fprintf(stderr, "%s, rank %d: %s\n", name.c_str(), team().rank(), ending.text.c_str());
  }
  std::cout.flush();
  std::fflush(nullptr);
  std::_Exit(ending.code);
}

}  // namespace

int runProgram(const std::string& name, const std::function<bool()>& body, Signals signals) {
  std::optional<io::InterruptionGuard> guard;
  if (signals == Signals::noted) guard.emplace();
  const Ending ending = endingOf(body);
  if (!ending.text.empty()) std::cerr << name << ": " << ending.text << std::endl;
  if (ending.code != 0 && team().size() > 1) leaveTeam(name, ending);
  return ending.code;
}

int runProgram(Options& options, int argc, char** argv, const std::function<bool()>& body) {
  return runProgram(options.program(), [&] { return !options.parse(argc, argv) || body(); });
}

}  // namespace dovetail::program
