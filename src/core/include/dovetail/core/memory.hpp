// What memory there is, and what a process holds of it.
#pragma once

namespace dovetail {

/// Bytes that this process may still take: the least of what the system has to give, what its control groups leave
/// (versions 1 and 2) and what its limit of address space does. Infinite where nothing tells.
double availableMemory();

/// Bytes that this process holds now; 0 where nothing tells.
double residentMemory();

}  // namespace dovetail
