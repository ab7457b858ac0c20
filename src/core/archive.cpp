#include "dovetail/core/archive.hpp"

#include <array>
#include <fstream>
#include <string_view>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail {

namespace {

struct Header {
  std::array<char, 8> magic{'D', 'O', 'V', 'E', 'T', 'A', 'I', 'L'};
  std::array<char, 16> kind{};
  std::uint64_t length = 0, checksum = 0;
};

/// FNV-1a, 64 bits.
std::uint64_t checksum(const std::vector<char>& bytes) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

std::array<char, 16> kindOf(const std::string& kind) {
  std::array<char, 16> letters{};
  for (std::size_t i = 0; i < std::min(kind.size(), letters.size()); ++i) letters[i] = kind[i];
  return letters;
}

/// Whether the file is one of writeChecked, of any kind.
bool isArchive(const std::filesystem::path& path) {
  const Header header;
  return headOf(path, header.magic.size()) == std::string_view(header.magic.data(), header.magic.size());
}

}  // namespace

void ByteReader::requireLeft(std::uint64_t count, std::size_t size) const {
  if (count > (bytes_.size() - next_) / size)
    throw InputError("the data ends early", "checkpoint", "write it anew with this version of the program");
}

void ByteReader::extract(void* data, std::size_t size) {
  requireLeft(1, size);
  std::memcpy(data, bytes_.data() + next_, size);
  next_ += size;
}

bool ByteReader::extractTruth() {
  static_assert(sizeof(bool) == 1);
  unsigned char byte = 0;
  extract(&byte, 1);
  if (byte > 1)
    throw InputError("a byte of a boolean is " + std::to_string(byte), "checkpoint",
                     "write it anew with this version of the program");
  return byte == 1;
}

void writeChecked(const std::filesystem::path& path, const std::string& kind, const std::vector<char>& bytes) {
  requireFreeOrOurs(path, isArchive);
  Header header;
  header.kind = kindOf(kind);
  header.length = bytes.size();
  header.checksum = checksum(bytes);
  const std::string_view head(reinterpret_cast<const char*>(&header), sizeof header);
  replaceFile(path, {head, {bytes.data(), bytes.size()}}, isArchive);
}

std::vector<char> readChecked(const std::filesystem::path& path, const std::string& kind) {
  std::ifstream in = openFile(path, std::ios::binary);
  if (!in) throw InputError("the file cannot be read", path.string(), "give the path of a checkpoint");
  Header header, wanted;
  in.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!in || header.magic != wanted.magic)
    throw InputError("the file is no checkpoint", path.string(), "give the path of a checkpoint");
  if (header.kind != kindOf(kind))
    throw InputError("the checkpoint is of another kind than " + kind, path.string(),
                     "read it with the program that wrote it");
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error || size != sizeof header + header.length)
    throw InputError("the checkpoint is cut off or has extra data", path.string(), "take an older one");
  std::vector<char> bytes(static_cast<std::size_t>(header.length));
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in || checksum(bytes) != header.checksum)
    throw InputError("the checkpoint has changed since it was written", path.string(), "take an older one");
  return bytes;
}

}  // namespace dovetail
