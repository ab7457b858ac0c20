// What PETSc makes, and destroys.
#pragma once

#include <petscsys.h>

namespace dovetail::linalg {

template <class T, PetscErrorCode (*destroy)(T*)>
class Owned {
public:
  Owned() = default;
  ~Owned() { reset(); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  void reset() {
    if (it_) destroy(&it_);
  }
  operator T() const { return it_; }
  T* fresh() {
    reset();
    return &it_;
  }

private:
  T it_ = nullptr;
};

}  // namespace dovetail::linalg
