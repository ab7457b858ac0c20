// Memory in large pages: fewer of them to look up where arrays are larger than the processor's caches.
#pragma once

#include <cstddef>
#include <vector>

namespace dovetail {

/// Asks the system to put [data, data + bytes) into pages of 2 MB as far as they fit; the content stays. Cheap where
/// that has been done before. Arrays of less than 2 MB and systems without such pages are left as they are.
void preferLargePages(const void* data, std::size_t bytes);

template <class T>
void preferLargePages(const std::vector<T>& array) {
  preferLargePages(array.data(), array.size() * sizeof(T));
}

}  // namespace dovetail
