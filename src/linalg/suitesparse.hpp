// What the factorisations by SuiteSparse share.
#pragma once

#include <SuiteSparse_config.h>
#include <dlfcn.h>

#include <algorithm>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/linalg/sparse.hpp"

namespace dovetail::linalg::detail {

/// Holds OpenBLAS, if that is the BLAS in use, to one thread: its sums depend on the number of threads.
class OneBlasThread {
public:
  OneBlasThread() {
    if (get() && set()) {
      before_ = get()();
      if (before_ != 1) set()(1);
    }
  }
  ~OneBlasThread() {
    if (before_ > 1) set()(before_);
  }
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

private:
  using Get = int (*)();
  using Set = void (*)(int);
  static Get get() {
    static const auto f = reinterpret_cast<Get>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
    return f;
  }
  static Set set() {
    static const auto f = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    return f;
  }
  int before_ = 1;
};

/// The pattern of a matrix in 64-bit numbers: factors of 3-D solids pass 2³¹ entries long before their matrices do.
struct LongPattern {
  std::vector<SuiteSparse_long> offsets, row;
  bool isOf(const SparseMatrix& A) const {
    return std::ranges::equal(offsets, A.offsets) && std::ranges::equal(row, A.row);
  }
  void take(const SparseMatrix& A) {
    offsets.assign(A.offsets.begin(), A.offsets.end());
    row.assign(A.row.begin(), A.row.end());
  }
};

[[noreturn]] inline void throwOutOfMemory(const char* package, const SparseMatrix& A) {
  throw FactorMemoryError(std::string(package) + " finds no memory for its factors",
                          std::to_string(A.size) + " unknowns, " + std::to_string(A.value.size()) + " entries",
                          "take a coarser mesh, a machine with more memory, or conjugate gradients");
}
[[noreturn]] inline void throwTooLarge(const char* package, const SparseMatrix& A) {
  throw FactorMemoryError(std::string(package) + " cannot number the entries of its factors",
                          std::to_string(A.size) + " unknowns, " + std::to_string(A.value.size()) + " entries",
                          "take a coarser mesh, or conjugate gradients");
}
[[noreturn]] inline void throwRefused(const char* package, int status) {
  throw NumericalError(std::string(package) + " refuses the matrix with status " + std::to_string(status),
                       "factorisation", "report this with the mesh that leads to it");
}

}  // namespace dovetail::linalg::detail
