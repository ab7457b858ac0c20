#include "dovetail/ranks/session.hpp"

#include <petscsys.h>

#include <cstdlib>
#include <new>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/core/team.hpp"

namespace dovetail::ranks {

namespace {

/// Ends what it started.
class Session {
public:
  Session() {
    PetscBool started = PETSC_FALSE;
    PetscInitialized(&started);
    if (started) return;
    require(PetscOptionsSetValue(nullptr, "-no_signal_handler", "true"), "starting PETSc");
    require(PetscInitializeNoArguments(), "starting PETSc");
    ours_ = true;
    PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr);
  }
  ~Session() {
    if (ours_) PetscFinalize();
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

private:
  bool ours_ = false;
};

}  // namespace

int rank() {
  int rank = 0;
  require(MPI_Comm_rank(MPI_COMM_WORLD, &rank), "asking for the rank");
  return rank;
}

int count() {
  int count = 1;
  require(MPI_Comm_size(MPI_COMM_WORLD, &count), "counting the ranks");
  return count;
}

void abortAll() {
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}

void start() { static const Session session; }

void require(int code, const char* doing) {
  if (code == 0) return;
  if (code == PETSC_ERR_MEM) throw std::bad_alloc();
  const char* text = nullptr;
  PetscErrorMessage(static_cast<PetscErrorCode>(code), &text, nullptr);
  const std::string what =
      "PETSc or MPI stops with code " + std::to_string(code) + (text ? std::string(": ") + text : "");
  // Others of a team are not out of it: this one may not try again without them.
  if (team().size() > 1) throw LostError(what, doing, "take one process, or more ranks");
  throw NumericalError(what, doing, "take another linear solver, or one process");
}

}  // namespace dovetail::ranks
