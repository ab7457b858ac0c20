// Vectors that do not write what nobody reads.
#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace dovetail {

/// Allocator whose vectors leave new elements of plain types as the memory comes: resize(n) touches nothing, so that
/// threads may fill a vector that is made by one, and its pages then lie next to those who fill them.
template <class T>
struct LeaveUnwritten : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = LeaveUnwritten<U>;
  };
  LeaveUnwritten() = default;
  template <class U>
  LeaveUnwritten(const LeaveUnwritten<U>&) {}

  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// Elements that resize adds must be written before they are read.
template <class T>
using RawVector = std::vector<T, LeaveUnwritten<T>>;

}  // namespace dovetail
