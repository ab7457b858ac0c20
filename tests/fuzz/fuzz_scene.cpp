// Any text as a scene: it is refused by an InputError that says where, or read; what is read is written in full, and
// that gives the same scene again.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/scene/read.hpp"

using namespace dovetail;

namespace {

[[noreturn]] void fail(const std::string& what, const std::string& text) {
  std::fprintf(stderr, "%s\n%s\n", what.c_str(), text.c_str());
  std::abort();
}

void requireGoodRefusal(const std::string& message) {
  if (message.find('\n') != std::string::npos) fail("a message of more than one line", message);
  if (message.find(".json") == std::string::npos) fail("a message that does not say where", message);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::string full;
  try {
    full = scene::sceneText(scene::sceneFromText(text, "s.json", SCENES));
  } catch (const InputError& error) {
    requireGoodRefusal(error.what());
    return 0;
  }
  try {
    const std::string again = scene::sceneText(scene::sceneFromText(full, "full.json", SCENES));
    if (again != full) fail("the scene in full gives another scene", full + "\n" + again);
  } catch (const InputError& error) {
    fail(std::string("the scene in full is refused: ") + error.what(), full);
  }
  return 0;
}
