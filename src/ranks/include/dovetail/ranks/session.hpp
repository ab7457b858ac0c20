// MPI and PETSc, which all that works on ranks stands on.
#pragma once

namespace dovetail::ranks {

/// Starts MPI and PETSc where nobody has; what this starts ends with the program. PETSc leaves signals alone, and its
/// errors come back as codes: see require(). To be called from the program's first thread.
/// @throws NumericalError if they do not start
void start();

/// @param code  of a call of PETSc @param doing  for the message
/// @throws NumericalError unless it is 0; std::bad_alloc for lack of memory
void require(int code, const char* doing);

}  // namespace dovetail::ranks
