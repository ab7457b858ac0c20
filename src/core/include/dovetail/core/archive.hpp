// State to bytes and back: one list of fields per structure serves for both ways.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace dovetail {

/// Collects bytes. `archive(a, b, …)` takes numbers, plain structures of them, vectors and optionals of such, and
/// texts. A structure with gaps between or behind its members, whose bytes nobody sets, has a function
/// archiveFields(archive, value) in its namespace that names its members, for both ways: then equal values are equal
/// bytes.
class ByteWriter {
public:
  static constexpr bool reads = false;
  template <class... Fields>
  void operator()(const Fields&... fields) {
    (write(fields), ...);
  }
  /// As they are, without their number: what another writer has written.
  void append(std::span<const char> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  const std::vector<char>& bytes() const { return bytes_; }
  std::vector<char> take() { return std::move(bytes_); }

private:
  template <class T>
  void write(const T& value) {
    if constexpr (requires { archiveFields(*this, value); }) {
      archiveFields(*this, value);
    } else {
      static_assert(std::is_trivially_copyable_v<T>, "give this structure a list of fields of its own");
      append(&value, sizeof value);
    }
  }
  template <class T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    write(value.value_or(T{}));
  }
  template <class T, class Allocator>
  void write(const std::vector<T, Allocator>& values) {
    const std::uint64_t count = values.size();
    append(&count, sizeof count);
    if constexpr (requires { archiveFields(*this, values[0]); }) {
      for (const T& value : values) archiveFields(*this, value);
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      if (count > 0) append(values.data(), count * sizeof(T));
    }
  }
  void write(const std::string& text) { write(std::vector<char>(text.begin(), text.end())); }
  void append(const void* data, std::size_t size) {
    const char* const from = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
  }
  std::vector<char> bytes_;
};

/// Hands bytes out again, in the order in which they were written.
/// @throws InputError if there are not enough, or one stands for a truth and is neither 0 nor 1
class ByteReader {
public:
  static constexpr bool reads = true;
  explicit ByteReader(std::vector<char> bytes) : bytes_(std::move(bytes)) {}
  template <class... Fields>
  void operator()(Fields&... fields) {
    (read(fields), ...);
  }
  bool atEnd() const { return next_ == bytes_.size(); }
  std::size_t position() const { return next_; }
  /// What was handed out since a position.
  std::span<const char> since(std::size_t position) const {
    return std::span(bytes_).subspan(position, next_ - position);
  }

private:
  template <class T>
  void read(T& value) {
    if constexpr (requires { archiveFields(*this, value); }) {
      archiveFields(*this, value);
    } else if constexpr (std::is_same_v<T, bool>) {
      value = extractTruth();
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      extract(&value, sizeof value);
    }
  }
  template <class T>
  void read(std::optional<T>& value) {
    bool there = false;
    T content{};
    read(there);
    read(content);
    value = there ? std::optional<T>(content) : std::nullopt;
  }
  template <class T, class Allocator>
  void read(std::vector<T, Allocator>& values) {
    std::uint64_t count = 0;
    extract(&count, sizeof count);
    if constexpr (requires { archiveFields(*this, values[0]); }) {
      requireLeft(count, 1);
      values.resize(static_cast<std::size_t>(count));
      for (T& value : values) archiveFields(*this, value);
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      requireLeft(count, sizeof(T));
      values.resize(static_cast<std::size_t>(count));
      if (count > 0) extract(values.data(), static_cast<std::size_t>(count) * sizeof(T));
    }
  }
  void read(std::string& text) {
    std::vector<char> letters;
    read(letters);
    text.assign(letters.begin(), letters.end());
  }
  void requireLeft(std::uint64_t count, std::size_t size) const;
  void extract(void* data, std::size_t size);
  bool extractTruth();
  std::vector<char> bytes_;
  std::size_t next_ = 0;
};

/// Writes bytes behind a header with their kind, length and checksum, by replaceFile (atomic_file.hpp): whatever
/// happens, the old file or the new one is there, and it replaces nothing but files of its own.
/// @param kind up to 16 characters, told apart when read
/// @throws InputError if the file cannot be written there; Error if writing breaks off (disk full)
void writeChecked(const std::filesystem::path& path, const std::string& kind, const std::vector<char>& bytes);
/// @throws InputError if the file cannot be read, is of another kind, is cut off, or has changed since it was written
std::vector<char> readChecked(const std::filesystem::path& path, const std::string& kind);

}  // namespace dovetail
