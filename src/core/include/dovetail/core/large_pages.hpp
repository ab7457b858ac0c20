// Memory in large pages: fewer of them to look up where arrays are larger than the processor's caches.
#pragma once

#include <cstddef>

namespace dovetail {

/// Asks the system to put [data, data + bytes) into pages of 2 MB as far as they fit; the content stays. Cheap where
/// that has been done before. Arrays of less than 2 MB and systems without such pages are left as they are.
void preferLargePages(const void* data, std::size_t bytes);

template <class Array>
void preferLargePages(const Array& array) {
  preferLargePages(array.data(), array.size() * sizeof(*array.data()));
}

}  // namespace dovetail
