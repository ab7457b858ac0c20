#include "dovetail/ranks/session.hpp"

#include <petscsys.h>

#include <new>
#include <string>

#include "dovetail/core/error.hpp"

namespace dovetail::ranks {

namespace {

/// Ends what it started.
class Session {
public:
  Session() {
    PetscBool started = PETSC_FALSE;
    PetscInitialized(&started);
    if (started) return;
    require(PetscInitializeNoArguments(), "starting PETSc");
    ours_ = true;
    PetscPopSignalHandler();
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

void start() { static const Session session; }

void require(int code, const char* doing) {
  if (code == 0) return;
  if (code == PETSC_ERR_MEM) throw std::bad_alloc();
  const char* text = nullptr;
  PetscErrorMessage(static_cast<PetscErrorCode>(code), &text, nullptr);
  throw NumericalError("PETSc stops with code " + std::to_string(code) + (text ? std::string(": ") + text : ""), doing,
                       "take another linear solver");
}

}  // namespace dovetail::ranks
