#include "program/run.hpp"

#include <iostream>
#include <new>

#include "dovetail/core/error.hpp"
#include "dovetail/io/interruption.hpp"

namespace dovetail::program {

int runProgram(const std::string& name, const std::function<bool()>& body) {
  const io::InterruptionGuard guard;
  try {
    if (body()) return 0;
    return io::interruption() != 0 ? 128 + io::interruption() : 1;
  } catch (const InputError& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return 2;
  } catch (const std::bad_alloc&) {
    std::cerr << name << ": there is not enough memory: take fewer grains or cells, or a machine with more\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return 1;
  }
}

int runProgram(Options& options, int argc, char** argv, const std::function<bool()>& body) {
  return runProgram(options.program(), [&] { return !options.parse(argc, argv) || body(); });
}

}  // namespace dovetail::program
