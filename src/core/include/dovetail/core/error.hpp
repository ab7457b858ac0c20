// Errors say what is wrong, where, and what to write instead.
#pragma once

#include <stdexcept>
#include <string>

namespace dovetail {

/// Base of every error this library throws. what() is one line: "problem [where]: remedy".
class Error : public std::runtime_error {
public:
  Error(const std::string& problem, const std::string& where, const std::string& remedy)
      : std::runtime_error(compose(problem, where, remedy)) {}

private:
  static std::string compose(const std::string& problem, const std::string& where, const std::string& remedy) {
    std::string line = problem;
    if (!where.empty()) line += " [" + where + "]";
    if (!remedy.empty()) line += ": " + remedy;
    return line;
  }
};

/// The caller asked for something that cannot be done; nothing was computed or overwritten.
/// Programs exit with code 2.
class InputError : public Error {
  using Error::Error;
};

/// A run broke down (NaN, inverted element, solver without convergence). Programs exit with code 1.
class NumericalError : public Error {
  using Error::Error;
};

}  // namespace dovetail
