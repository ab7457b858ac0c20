// State to bytes and back: one list of fields per structure serves for both ways.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

namespace dovetail {

/// Collects bytes. `archive(a, b, …)` takes numbers, plain structures of them, and vectors of such.
class ByteWriter {
public:
  static constexpr bool reads = false;
  template <class... Fields>
  void operator()(const Fields&... fields) {
    (write(fields), ...);
  }
  const std::vector<char>& bytes() const { return bytes_; }

private:
  template <class T>
  void write(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>, "give this structure a list of fields of its own");
    append(&value, sizeof value);
  }
  template <class T, class Allocator>
  void write(const std::vector<T, Allocator>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::uint64_t count = values.size();
    append(&count, sizeof count);
    if (count > 0) append(values.data(), count * sizeof(T));
  }
  void append(const void* data, std::size_t size) {
    const char* const from = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
  }
  std::vector<char> bytes_;
};

/// Hands bytes out again, in the order in which they were written.
/// @throws InputError if there are not enough
class ByteReader {
public:
  static constexpr bool reads = true;
  explicit ByteReader(std::vector<char> bytes) : bytes_(std::move(bytes)) {}
  template <class... Fields>
  void operator()(Fields&... fields) {
    (read(fields), ...);
  }
  bool atEnd() const { return next_ == bytes_.size(); }

private:
  template <class T>
  void read(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    extract(&value, sizeof value);
  }
  template <class T, class Allocator>
  void read(std::vector<T, Allocator>& values) {
    std::uint64_t count = 0;
    extract(&count, sizeof count);
    requireLeft(count, sizeof(T));
    values.resize(static_cast<std::size_t>(count));
    if (count > 0) extract(values.data(), static_cast<std::size_t>(count) * sizeof(T));
  }
  void requireLeft(std::uint64_t count, std::size_t size) const;
  void extract(void* data, std::size_t size);
  std::vector<char> bytes_;
  std::size_t next_ = 0;
};

/// Writes bytes behind a header with their kind, length and checksum: to a file beside it first, then in its place, so
/// that a run cut off leaves the old one whole.
/// @param kind up to 16 characters, told apart when read
/// @throws InputError if the file cannot be written
void writeChecked(const std::filesystem::path& path, const std::string& kind, const std::vector<char>& bytes);
/// @throws InputError if the file cannot be read, is of another kind, is cut off, or has changed since it was written
std::vector<char> readChecked(const std::filesystem::path& path, const std::string& kind);

}  // namespace dovetail
