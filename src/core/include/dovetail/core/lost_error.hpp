// Errors after which nothing can be tried again.
#pragma once

#include "dovetail/core/error.hpp"

namespace dovetail {

/// What the computation stands on is gone, such as another process with its part of it: trying again, with a smaller
/// step for instance, is of no use. Programs exit with code 1.
class LostError : public Error {
  using Error::Error;
};

}  // namespace dovetail
