// What went wrong in another process.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <utility>

namespace dovetail {

enum class Failure : std::uint8_t {
  none,
  input,
  numerical,
  other,
  lost  ///< nothing can be tried again: see LostError
};

/// Of what is being thrown, with its text.
std::pair<Failure, std::string> failureNow();
/// Throws it here. @param where  it was thrown
[[noreturn]] void raise(Failure failure, const std::string& text, const std::string& where);

/// What the program still has to say, such as where its last checkpoint is, should it be ended without getting to its
/// own end. Of any thread.
void setLastWords(std::string words);
std::string lastWords();

}  // namespace dovetail
