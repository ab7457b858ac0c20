#include "netcdf_file.hpp"

#include <bit>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/io/text_source.hpp"

namespace dovetail::solid_io {

namespace {

/// Numbers of types, of those that are named here.
struct Type {
  static constexpr std::uint32_t character = 2, real = 5, doubleReal = 6, ubyte = 7, int64 = 10;
};

/// Bytes of a value; 0 for other types.
std::size_t sizeOf(std::uint32_t type) {
  constexpr std::size_t sizes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};  // char is 2, double 6, uint64 11
  return type < std::size(sizes) ? sizes[type] : 0;
}

std::uint64_t bigEndian(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < size; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

std::string_view withoutPadding(std::string_view text) {
  const std::size_t zero = text.find('\0');
  return io::trimmed(text.substr(0, zero));
}

}  // namespace

/// Reads the header, from front to back.
class NetcdfFile::Header {
public:
  explicit Header(NetcdfFile& file) : file_(file), bytes_(file.bytes_) {}

  void read() {
    if (bytes_.starts_with("\x89HDF"))
      throw InputError("the file is of netCDF-4 (HDF5)", file_.name_,
                       "write it in the classic format: nccopy -k cdf5 OLD NEW");
    if (!bytes_.starts_with("CDF") || bytes_.size() < 4) refuse("the file is no netCDF file");
    version_ = bytes_[3];
    if (version_ != 1 && version_ != 2 && version_ != 5) refuse("the file is of no classic netCDF format");
    at_ = 4;
    count();  // of records
    readDimensions();
    attributes();
    readVariables();
  }

private:
  [[noreturn]] void refuse(const std::string& problem) const {
    throw InputError(problem, file_.name_ + ", byte " + std::to_string(at_), "give a whole Exodus file");
  }
  std::uint64_t number(std::size_t size) {
    if (bytes_.size() - at_ < size) refuse("the file breaks off");
    at_ += size;
    return bigEndian(bytes_, at_ - size, size);
  }
  std::uint64_t count() { return number(version_ == 5 ? 8 : 4); }
  /// Of entries that take four bytes at least.
  std::size_t list(std::uint32_t kind) {
    const std::uint64_t tag = number(4), entries = count();
    if (entries == 0) return 0;
    if (tag != kind) refuse("a list is of another kind");
    if (entries > (bytes_.size() - at_) / 4) refuse("a list is longer than the file");
    return static_cast<std::size_t>(entries);
  }
  /// So many bytes, and on to a multiple of four.
  std::string_view take(std::uint64_t size) {
    if (size > bytes_.size() - at_) refuse("the file breaks off");
    const std::string_view text = bytes_.substr(at_, static_cast<std::size_t>(size));
    at_ = std::min(bytes_.size(), at_ + (static_cast<std::size_t>(size) + 3) / 4 * 4);
    return text;
  }
  std::string text() { return std::string(take(count())); }

  void readDimensions() {
    for (std::size_t k = 0, all = list(10); k < all; ++k) {
      const std::string name = text();
      lengths_.push_back(count());
      file_.dimensions_[name] = static_cast<std::size_t>(lengths_.back());
    }
  }
  std::map<std::string, std::string> attributes() {
    std::map<std::string, std::string> all;
    for (std::size_t k = 0, entries = list(12); k < entries; ++k) {
      const std::string name = text();
      const auto type = static_cast<std::uint32_t>(number(4));
      const std::uint64_t values = count();
      if (sizeOf(type) == 0 || values > bytes_.size()) refuse("an attribute is of no known type, or too long");
      const std::string_view bytes = take(values * sizeOf(type));
      if (type == Type::character) all[name] = withoutPadding(bytes);
    }
    return all;
  }
  void readVariables() {
    for (std::size_t k = 0, all = list(11); k < all; ++k) {
      Variable& variable = file_.variables_[text()];
      variable = {};
      const std::uint64_t rank = count();
      if (rank > 8) refuse("a variable has " + std::to_string(rank) + " dimensions");
      for (std::uint64_t d = 0; d < rank; ++d) {
        const std::uint64_t which = count();
        if (which >= lengths_.size()) refuse("a variable has a dimension that is not there");
        variable.ofRecords |= lengths_[which] == 0;
        variable.shape.push_back(static_cast<std::size_t>(lengths_[which]));
      }
      variable.attributes = attributes();
      variable.type = static_cast<std::uint32_t>(number(4));
      count();  // bytes, which follow from the shape
      variable.begin = number(version_ == 1 ? 4 : 8);
    }
  }

  NetcdfFile& file_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  int version_ = 0;
  std::vector<std::uint64_t> lengths_;
};

NetcdfFile::NetcdfFile(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {
  Header(*this).read();
}

std::size_t NetcdfFile::dimension(const std::string& name) const {
  const auto found = dimensions_.find(name);
  return found == dimensions_.end() ? 0 : found->second;
}

std::vector<std::size_t> NetcdfFile::shape(const std::string& variable) const {
  const auto found = variables_.find(variable);
  return found == variables_.end() ? std::vector<std::size_t>{} : found->second.shape;
}

const NetcdfFile::Variable& NetcdfFile::need(const std::string& variable) const {
  const auto found = variables_.find(variable);
  if (found == variables_.end())
    throw InputError("there is no variable " + variable, name_, "give a whole Exodus file");
  return found->second;
}

std::string_view NetcdfFile::bytesOf(const Variable& variable, const std::string& name, std::size_t& count) const {
  const std::size_t size = sizeOf(variable.type);
  double values = 1.0;
  for (const std::size_t length : variable.shape) values *= static_cast<double>(length);
  if (size == 0 || variable.ofRecords || variable.begin > bytes_.size() ||
      values * static_cast<double>(size) > static_cast<double>(bytes_.size() - variable.begin))
    throw InputError("the variable " + name + " is of no known type, or not whole", name_, "give a whole Exodus file");
  count = static_cast<std::size_t>(values);
  return bytes_.substr(static_cast<std::size_t>(variable.begin), count * size);
}

std::vector<std::int64_t> NetcdfFile::integers(const std::string& variable) const {
  const Variable& found = need(variable);
  std::size_t count = 0;
  const std::string_view bytes = bytesOf(found, variable, count);
  const std::size_t size = sizeOf(found.type);
  if (found.type == Type::character || found.type == Type::real || found.type == Type::doubleReal)
    throw InputError("the variable " + variable + " has no whole numbers", name_, "give a whole Exodus file");
  const bool isSigned = found.type < Type::ubyte || found.type == Type::int64;
  std::vector<std::int64_t> values(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t bits = bigEndian(bytes, k * size, size);
    const unsigned above = static_cast<unsigned>(64 - 8 * size);
    values[k] = isSigned ? static_cast<std::int64_t>(bits << above) >> above : static_cast<std::int64_t>(bits);
  }
  return values;
}

std::vector<double> NetcdfFile::reals(const std::string& variable) const {
  const Variable& found = need(variable);
  std::size_t count = 0;
  const std::string_view bytes = bytesOf(found, variable, count);
  if (found.type != Type::real && found.type != Type::doubleReal)
    throw InputError("the variable " + variable + " has no real numbers", name_, "give a whole Exodus file");
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k)
    values[k] = found.type == Type::real
                    ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bigEndian(bytes, 4 * k, 4))))
                    : std::bit_cast<double>(bigEndian(bytes, 8 * k, 8));
  return values;
}

std::vector<std::string> NetcdfFile::texts(const std::string& variable) const {
  if (!has(variable)) return {};
  const Variable& found = need(variable);
  std::size_t count = 0;
  const std::string_view bytes = bytesOf(found, variable, count);
  if (found.type != Type::character || found.shape.size() != 2) return {};
  std::vector<std::string> rows;
  for (std::size_t k = 0; k < found.shape[0]; ++k)
    rows.emplace_back(withoutPadding(bytes.substr(k * found.shape[1], found.shape[1])));
  return rows;
}

std::string NetcdfFile::attribute(const std::string& variable, const std::string& name) const {
  const auto& all = need(variable).attributes;
  const auto found = all.find(name);
  return found == all.end() ? std::string() : found->second;
}

}  // namespace dovetail::solid_io
