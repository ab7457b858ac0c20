#include "dovetail/core/failure.hpp"

#include <mutex>
#include <new>

#include "dovetail/core/error.hpp"
#include "dovetail/core/lost_error.hpp"

namespace dovetail {

namespace {

struct LastWords {
  std::mutex mutex;
  std::string text;
};

LastWords& theLastWords() {
  static LastWords words;
  return words;
}

}  // namespace

void setLastWords(std::string words) {
  const std::scoped_lock lock(theLastWords().mutex);
  theLastWords().text = std::move(words);
}

std::string lastWords() {
  const std::scoped_lock lock(theLastWords().mutex);
  return theLastWords().text;
}

std::pair<Failure, std::string> failureNow() {
  try {
    throw;
  } catch (const InputError& error) {
    return {Failure::input, error.what()};
  } catch (const NumericalError& error) {
    return {Failure::numerical, error.what()};
  } catch (const LostError& error) {
    return {Failure::lost, error.what()};
  } catch (const std::bad_alloc&) {
    return {Failure::lost, "there is not enough memory"};
  } catch (const std::exception& error) {
    return {Failure::other, error.what()};
  }
}

void raise(Failure failure, const std::string& text, const std::string& where) {
  switch (failure) {
    case Failure::input:
      throw InputError(text, where, "");
    case Failure::numerical:
      throw NumericalError(text, where, "");
    case Failure::lost:
      throw LostError(text, where, "");
    default:
      throw Error(text, where, "");
  }
}

}  // namespace dovetail
