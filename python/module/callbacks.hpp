// Functions of Python's that the library calls.
#pragma once

#include <pybind11/pybind11.h>

#include <streambuf>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/io/interruption.hpp"

namespace dovetail::python {

namespace py = pybind11;

/// Passes whole lines on to a function of Python's.
class Lines final : public std::streambuf {
public:
  explicit Lines(const py::function& write) : write_(write) {}

private:
  int overflow(int c) override {
    if (c != traits_type::eof()) line_ += static_cast<char>(c);
    if (c == '\n') sync();
    return c;
  }
  std::streamsize xsputn(const char* text, std::streamsize n) override {
    line_.append(text, static_cast<std::size_t>(n));
    if (line_.ends_with('\n')) sync();
    return n;
  }
  int sync() override {
    if (line_.empty()) return 0;
    const py::gil_scoped_acquire lock;
    write_(std::exchange(line_, {}));
    return 0;
  }
  const py::function& write_;
  std::string line_;
};

/// A run under way ends at Ctrl-C as the program does: with a checkpoint.
inline void endAs(bool finished) {
  if (finished || io::interruption() == 0) return;
  PyErr_SetString(PyExc_KeyboardInterrupt, io::nameOfInterruption().c_str());
  throw py::error_already_set();
}

/// Whether an exception of Python's is one of the module's by this name.
inline bool isOurs(const py::error_already_set& error, const char* name) {
  return error.matches(py::module_::import("dovetail._core").attr(name));
}

/// Calls a function of Python's; what it refuses as InputError, or breaks down with as NumericalError, is so here.
template <class Act>
auto callOurs(Act act) {
  try {
    return act();
  } catch (const py::error_already_set& error) {
    const std::string text = py::str(error.value());
    if (isOurs(error, "InputError")) throw InputError(text, "", "");
    if (isOurs(error, "NumericalError")) throw NumericalError(text, "", "");
    throw;
  }
}

}  // namespace dovetail::python
