// MPI and PETSc, which all that works on ranks stands on.
#pragma once

namespace dovetail::ranks {

/// Starts MPI and PETSc where nobody has; what this starts ends with the program, on all ranks at the same time. PETSc
/// leaves signals alone, and its errors come back as codes: see require(). To be called from the program's first
/// thread, on all ranks.
/// @throws NumericalError if they do not start
void start();

/// Of this process, and of all, once start() was called.
int rank();
int count();

/// Ends all ranks at once, for one that cannot go on.
[[noreturn]] void abortAll();

/// @param code  of a call of PETSc or MPI @param doing  for the message
/// @throws NumericalError unless it is 0, LostError on ranks of a team; std::bad_alloc for lack of memory
void require(int code, const char* doing);

}  // namespace dovetail::ranks
